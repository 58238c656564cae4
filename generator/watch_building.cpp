#include "generator/watch_building.h"

#include <string>
#include <thread>

#include "generator/run_stopped.h"
#include "generator/terminal_line.h"

namespace railcast {

void WatchBuilding(Simulator& simulator, const std::function<bool()>& is_stopped) {
  const TerminalLine line;
  const std::thread::id waiting = std::this_thread::get_id();
  simulator.UseProgress([=](std::size_t num_done, std::size_t num_steps) {
    if (is_stopped()) throw RunStopped();
    if (std::this_thread::get_id() != waiting) return;
    line.Show(num_done == num_steps
                  ? ""
                  : "building the scene: " + std::to_string(100 * num_done / num_steps) + " %");
  });
}

}  // namespace railcast
