#pragma once

#include <string>

#include "tests/support/run_command.h"

namespace railcast {

/// Runs railcast-generate with these arguments.
inline Ended Generate(const std::string& arguments) {
  return RunCommand(std::string(RAILCAST_GENERATE) + " " + arguments);
}

/// As Generate(), for runs that wait for somebody, who may never come where a test fails: they are
/// ended after two minutes, with status 124.
inline Ended GenerateLive(const std::string& arguments) {
  return RunCommand("timeout --foreground --kill-after=10 120 " RAILCAST_GENERATE " " + arguments);
}

}  // namespace railcast
