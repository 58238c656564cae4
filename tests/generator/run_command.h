#pragma once

#include <string>

#include "tests/support/run_command.h"

namespace railcast {

/// Runs railcast-generate with these arguments.
inline Ended Generate(const std::string& arguments) {
  return RunCommand(std::string(RAILCAST_GENERATE) + " " + arguments);
}

}  // namespace railcast
