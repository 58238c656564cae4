#pragma once

namespace railcast {

/// From now on StopSignals() end the program in order: StopRequested() is true after the first. A
/// second one of its kind ends it at once.
void CatchStopSignals();

[[nodiscard]] bool StopRequested();

/// Whether a stop that is requested from now on must not take longer than half a second: if this is
/// still so then, the program ends at once, with kExitInterrupted. For work that cannot be stopped
/// and leaves nothing behind that must be tidied up.
void UseStopDeadline(bool has_deadline);

}  // namespace railcast
