#include "generator/run/stopping.h"

#include <signal.h>
#include <sys/time.h>
#include <unistd.h>

#include <atomic>
#include <cmath>
#include <string>
#include <string_view>
#include <thread>

#include "core/program/program.h"
#include "core/program/progress_line.h"

namespace railcast {
namespace {

// Global because a signal handler cannot be given any data.
std::atomic<bool> stop_requested{false};
std::atomic<bool> has_stop_deadline{false};
std::atomic<bool> is_terminal{false};
static_assert(std::atomic<bool>::is_always_lock_free);

void RequestStop(int /*signal*/) {
  stop_requested = true;
  constexpr itimerval kPatience{{0, 0}, {0, 500'000}};
  if (has_stop_deadline) ::setitimer(ITIMER_REAL, &kPatience, nullptr);
}

void EndIfBusy(int /*signal*/) {
  if (!has_stop_deadline) return;
  // Overwrites the progress shown on the terminal: CR, ESC [K.
  const std::string_view line = is_terminal ? "\r\033[Kinterrupted\n" : "interrupted\n";
  static_cast<void>(!::write(STDERR_FILENO, line.data(), line.size()));
  ::_exit(kExitInterrupted);
}

}  // namespace

void CatchStopSignals() {
  is_terminal = ::isatty(STDERR_FILENO) == 1;
  struct sigaction action {};
  action.sa_handler = RequestStop;
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  for (const int signal : StopSignals()) ::sigaction(signal, &action, nullptr);
  struct sigaction deadline {};
  deadline.sa_handler = EndIfBusy;
  deadline.sa_flags = SA_RESTART;
  ::sigaction(SIGALRM, &deadline, nullptr);
}

bool StopRequested() {
  return stop_requested;
}

void UseStopDeadline(bool has_deadline) {
  has_stop_deadline = has_deadline;
}

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
