#pragma once

#include <array>
#include <cmath>
#include <cstdio>
#include <string>

namespace railcast {

/// Returns a number with `num_decimals` decimals, "-2.900", or "-" for NaN. A value that rounds to
/// zero has no sign.
[[nodiscard]] inline std::string FixedText(double value, int num_decimals) {
  if (std::isnan(value)) return "-";
  std::array<char, 352> text{};  // The largest double has 309 digits.
  std::snprintf(text.data(), text.size(), "%.*f", num_decimals, value);
  std::string fixed = text.data();
  const bool is_zero = fixed.find_first_not_of("-0.") == std::string::npos;
  return is_zero && fixed.front() == '-' ? fixed.substr(1) : fixed;
}

}  // namespace railcast
