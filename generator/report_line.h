#pragma once

#include <iomanip>
#include <sstream>
#include <string>
#include <string_view>

namespace railcast {

/// A line of a paragraph of `check`; only the first has a head.
[[nodiscard]] inline std::string ReportLine(std::string_view head, const std::string& text) {
  constexpr int kHeadWidth = 10;
  std::ostringstream line;
  line << std::left << std::setw(kHeadWidth) << head << text << "\n";
  return line.str();
}

/// To four digits.
[[nodiscard]] inline std::string Short(double value) {
  std::ostringstream text;
  text << std::setprecision(4) << value;
  return text.str();
}

}  // namespace railcast
