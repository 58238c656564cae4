#pragma once

#include <signal.h>

namespace railcast {

/// Lets the signals that a terminal sends end the process. Background jobs of scripts and programs
/// under nohup are started with some of them ignored, and processes inherit that.
inline void UseDefaultSignals() {
  for (const int signal : {SIGINT, SIGHUP, SIGQUIT}) ::signal(signal, SIG_DFL);
}

}  // namespace railcast
