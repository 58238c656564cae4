#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

namespace railcast {

/// The median, of an even number of values the upper one of the two in the middle; NaN if there are
/// no values, and 0 if these are integers. Reorders the values.
template <typename Value>
[[nodiscard]] Value MedianOf(std::vector<Value>& values) {
  if (values.empty()) return std::numeric_limits<Value>::quiet_NaN();
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

}  // namespace railcast
