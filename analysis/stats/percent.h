#pragma once

#include <cstdint>
#include <limits>

namespace railcast {

/// A share in percent; NaN of nothing.
[[nodiscard]] inline double Percent(std::uint64_t part, std::uint64_t whole) {
  if (whole == 0) return std::numeric_limits<double>::quiet_NaN();
  return 100.0 * static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace railcast
