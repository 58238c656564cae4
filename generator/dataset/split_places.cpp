#include "generator/dataset/split_places.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>

namespace railcast {
namespace {

/// Hands out places one after the other.
class Division {
 public:
  Division(const PerPart<double>& shares, double weight) {
    for (std::size_t part = 0; part < kNumSplits; ++part) {
      owed_[part] = shares[part] * weight;
      is_lacking_[part] = shares[part] > 0.0;
    }
  }

  void Give(Split split, double weight) {
    const auto part = static_cast<std::size_t>(split);
    owed_[part] -= weight;
    is_lacking_[part] = false;
  }

  /// The part that is owed most; if no more places are left than parts that lack one, of these.
  [[nodiscard]] Split Next(std::size_t num_left, const PerPart<double>& shares) const {
    const bool must_lack = num_left <= num_lacking();
    std::optional<std::size_t> next;
    for (std::size_t part = 0; part < kNumSplits; ++part) {
      if (shares[part] == 0.0 || (must_lack && !is_lacking_[part])) continue;
      if (!next || owed_[part] > owed_[*next]) next = part;
    }
    return static_cast<Split>(next.value());
  }

  [[nodiscard]] std::size_t num_lacking() const {
    return static_cast<std::size_t>(std::ranges::count(is_lacking_, true));
  }

 private:
  PerPart<double> owed_{};
  PerPart<bool> is_lacking_{};
};

// Places in the order in which they are given: large ones first, since small ones can then make up
// for what these left uneven; those of about one size in random order.
std::vector<std::size_t> OrderOf(const std::vector<SplitPlace>& places, const KeyedDraws& draws) {
  struct Key {
    int size;
    double draw;
  };
  std::vector<Key> keys;
  for (const SplitPlace& place : places) {
    keys.push_back({-std::ilogb(place.weight), draws.Unit("split\nplace\n" + place.name)});
  }
  std::vector<std::size_t> order(places.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, [&](std::size_t a, std::size_t b) {
    return std::pair(keys[a].size, keys[a].draw) < std::pair(keys[b].size, keys[b].draw);
  });
  return order;
}

}  // namespace

std::optional<std::vector<Split>> DividePlaces(const std::vector<SplitPlace>& places,
                                               const PerPart<double>& shares,
                                               const KeyedDraws& draws) {
  double weight = 0.0;
  for (const SplitPlace& place : places) weight += place.weight;
  Division division(shares, weight);
  std::size_t num_left = 0;
  for (const SplitPlace& place : places) {
    if (place.pinned) {
      division.Give(*place.pinned, place.weight);
    } else {
      ++num_left;
    }
  }
  if (num_left < division.num_lacking()) return std::nullopt;
  std::vector<Split> splits(places.size());
  for (const std::size_t i : OrderOf(places, draws)) {
    if (places[i].pinned) {
      splits[i] = *places[i].pinned;
      continue;
    }
    splits[i] = division.Next(num_left--, shares);
    division.Give(splits[i], places[i].weight);
  }
  return splits;
}

}  // namespace railcast
