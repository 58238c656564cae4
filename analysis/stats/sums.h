#pragma once

#include <cstddef>
#include <vector>

namespace railcast {

/// Adds each of `others` to its counterpart; `sums` grows to hold them all.
template <typename Sum>
void AddEach(std::vector<Sum>& sums, const std::vector<Sum>& others) {
  if (sums.size() < others.size()) sums.resize(others.size());
  for (std::size_t i = 0; i < others.size(); ++i) sums[i].Add(others[i]);
}

}  // namespace railcast
