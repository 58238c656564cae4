#pragma once

#include <signal.h>

#include <vector>

namespace railcast {

/// The signals that ask a program to end in order: SIGINT, SIGTERM and, unless it is ignored, as
/// under nohup, SIGHUP.
[[nodiscard]] inline std::vector<int> StopSignals() {
  std::vector<int> signals = {SIGINT, SIGTERM};
  struct sigaction hangup {};
  ::sigaction(SIGHUP, nullptr, &hangup);
  if (hangup.sa_handler != SIG_IGN) signals.push_back(SIGHUP);
  return signals;
}

}  // namespace railcast
