#pragma once

#include "core/fidelity/choice.h"

namespace railcast {

/// Makes fidelity auto's choice and gives it to the simulator, showing how far it is on the
/// terminal.
/// @pre The scenario's fidelity is `auto`; the simulator is the scenario's.
FidelityChoice UseChosenFidelity(Simulator& simulator, const ScenarioSpec& scenario);

}  // namespace railcast
