#pragma once

namespace railcast {

/// From now on StopSignals() end the program in order: StopRequested() is true after the first. A
/// second one of its kind ends it at once.
void CatchStopSignals();

[[nodiscard]] bool StopRequested();

}  // namespace railcast
