#pragma once

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "core/base/error.h"

namespace railcast {

/// Checks that each line is "place: rule", printable and valid UTF-8, so that terminals and logs
/// can show it.
inline void CheckFaultLines(const std::string& lines) {
  std::istringstream stream(lines);
  int num_lines = 0;
  for (std::string line; std::getline(stream, line); ++num_lines) {
    Check(line.find(": ") != std::string::npos, "a fault has a place");
    const auto is_control = [](char c) {
      return static_cast<unsigned char>(c) < 0x20 || c == 0x7F;
    };
    Check(std::none_of(line.begin(), line.end(), is_control), "a fault is printable");
    static_cast<void>(nlohmann::json(line).dump());  // Throws unless the line is UTF-8.
  }
  Check(num_lines > 0, "a fault is said");
}

}  // namespace railcast
