#pragma once

#include <functional>

#include "core/simulate/simulator.h"

namespace railcast {

/// From now on the terminal shows how far a window is that the calling thread waits for, and no
/// window is built on, here or in the background, once `is_stopped`: then the frame that needs it
/// ends with RunStopped. A chunk of a window takes a fraction of a second; what then still takes
/// longer, as the scene of millions of plants does, ends with the program (UseStopDeadline).
/// @param is_stopped Asked by several threads.
/// @param has_deadline Only while the program has nothing to tidy up: no capture to finish, no
///   datagrams to send.
void WatchBuilding(Simulator& simulator,
                   const std::function<bool()>& is_stopped,
                   bool has_deadline);

}  // namespace railcast
