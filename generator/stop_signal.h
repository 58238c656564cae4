#pragma once

namespace railcast {

/// From now on SIGINT and SIGTERM end the program in order: StopRequested() is true after the
/// first. A second one ends it at once.
void CatchStopSignals();

[[nodiscard]] bool StopRequested();

}  // namespace railcast
