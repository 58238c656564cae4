#include "generator/run/stopping.h"

#include <cmath>
#include <string>
#include <thread>

#include "core/program/progress_line.h"
#include "core/program/stop_signals.h"

namespace railcast {

void WatchBuilding(Simulator& simulator,
                   const std::function<bool()>& is_stopped,
                   bool has_deadline) {
  const TerminalLine line;
  const std::thread::id waiting = std::this_thread::get_id();
  simulator.UseProgress([=](std::size_t num_done, std::size_t num_steps) {
    const bool must_stop = is_stopped();
    if (std::this_thread::get_id() == waiting) {
      const bool is_over = must_stop || num_done == num_steps;
      const std::size_t percent = 100 * num_done / num_steps;
      if (has_deadline) UseStopDeadline(!is_over);
      line.Show(is_over ? "" : "building the scene: " + std::to_string(percent) + " %");
    }
    if (must_stop) throw RunStopped();
  });
}

void StopBuilding(Simulator& simulator, const std::function<bool()>& is_stopped) {
  simulator.UseProgress([=](std::size_t /*num_done*/, std::size_t /*num_steps*/) {
    if (is_stopped()) throw RunStopped();
  });
}

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
