#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace railcast {

/// Sets of items, given by their numbers from 0, that are joined one by one (union-find).
class JoinedSets {
 public:
  explicit JoinedSets(std::size_t num) : parents_(num) {
    std::iota(parents_.begin(), parents_.end(), std::size_t{0});
  }

  /// The least item of the set that an item is in.
  [[nodiscard]] std::size_t SetOf(std::size_t item) {
    while (parents_[item] != item) item = parents_[item] = parents_[parents_[item]];
    return item;
  }
  void Join(std::size_t one, std::size_t other) {
    one = SetOf(one);
    other = SetOf(other);
    parents_[std::max(one, other)] = std::min(one, other);
  }

 private:
  std::vector<std::size_t> parents_;
};

}  // namespace railcast
