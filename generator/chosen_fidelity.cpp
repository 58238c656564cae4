#include "generator/chosen_fidelity.h"

#include <cmath>
#include <string>

#include "generator/run_stopped.h"
#include "generator/stop_signal.h"
#include "generator/terminal_line.h"

namespace railcast {

FidelityChoice UseChosenFidelity(Simulator& simulator, const ScenarioSpec& scenario) {
  const TerminalLine line;
  FidelityChoice choice = UseChosenFidelity(simulator, scenario, [&](double done) {
    if (StopRequested()) {
      line.Show("");
      throw RunStopped();
    }
    line.Show("choosing effects: " + std::to_string(std::lround(100.0 * done)) + " %");
  });
  line.End();
  return choice;
}

}  // namespace railcast
