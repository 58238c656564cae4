#pragma once

namespace railcast {

/// From now on the signals of StopSignals() end the program cleanly: after the first one
/// StopRequested() is true. A second signal of the same kind ends the program at once.
void CatchStopSignals();

[[nodiscard]] bool StopRequested();

/// Sets whether a stop requested from now on may take no longer than half a second. If the deadline
/// is still set by then, the program ends at once with kExitInterrupted. For work that cannot be
/// interrupted and leaves nothing behind that must be cleaned up.
void UseStopDeadline(bool has_deadline);

}  // namespace railcast
