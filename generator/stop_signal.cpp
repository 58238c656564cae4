#include "generator/stop_signal.h"

#include <signal.h>

#include <atomic>

#include "core/io/stop_signals.h"

namespace railcast {
namespace {

// A signal handler can reach nothing else.
std::atomic<bool> stop_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free);

}  // namespace

void CatchStopSignals() {
  struct sigaction action {};
  action.sa_handler = [](int) { stop_requested = true; };
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  for (const int signal : StopSignals()) ::sigaction(signal, &action, nullptr);
}

bool StopRequested() {
  return stop_requested;
}

}  // namespace railcast
