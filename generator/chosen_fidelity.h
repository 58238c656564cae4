#pragma once

#include "core/fidelity/choice.h"

namespace railcast {

/// Makes fidelity auto's choice, showing how far it is, and gives it to the simulator.
/// @pre The scenario's fidelity is `auto`; the simulator is the scenario's.
FidelityChoice UseChosenFidelity(Simulator& simulator, const ScenarioSpec& scenario);

}  // namespace railcast
