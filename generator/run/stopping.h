#pragma once

#include <functional>

#include "railcast/fidelity.h"
#include "railcast/simulator.h"

namespace railcast {

/// Thrown when a run is told to stop in the middle of a frame. It is not a fault: the run ends
/// cleanly without that frame.
struct RunStopped {};

/// From now on the terminal shows the progress of building the window that the calling thread waits
/// for. Once `is_stopped` returns true, no window is built any further, here or in the background,
/// and the frame that needs it ends with RunStopped. One chunk of a window takes a fraction of a
/// second; a step that takes longer, as with a scene of millions of plants, is cut short by ending
/// the program (UseStopDeadline).
/// @param is_stopped Called from several threads.
/// @param has_deadline Set only while the program has nothing to clean up: no capture to finish, no
///   datagrams to send.
void WatchBuilding(Simulator& simulator,
                   const std::function<bool()>& is_stopped,
                   bool has_deadline);

/// The same without the terminal and without a deadline, for simulators that are used beside
/// others.
void StopBuilding(Simulator& simulator, const std::function<bool()>& is_stopped);

/// Makes fidelity auto's choice and applies it to the simulator, showing the progress on the
/// terminal.
/// @pre The scenario's fidelity is `auto`; the simulator is the scenario's.
FidelityChoice UseChosenFidelity(Simulator& simulator, const ScenarioSpec& scenario);

}  // namespace railcast
