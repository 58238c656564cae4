#include "core/program/stop_signals.h"

#include <signal.h>
#include <sys/time.h>
#include <unistd.h>

#include <atomic>
#include <string_view>

#include "core/program/program.h"

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

}  // namespace railcast
