#include "core/extras/recipe/split_quota.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>

#include "core/base/random.h"
#include "core/base/text.h"

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

// Gives a part without any one of those of the part that has the most above its share.
void FillEmptyParts(const PerPart<double>& shares,
                    std::uint32_t num,
                    PerPart<std::uint32_t>& quota) {
  for (std::size_t part = 0; part < kNumSplits; ++part) {
    if (shares[part] == 0.0 || quota[part] > 0) continue;
    std::size_t richest = part;
    double most = -static_cast<double>(num);
    for (std::size_t other = 0; other < kNumSplits; ++other) {
      const double excess = quota[other] - shares[other] * num;
      if (quota[other] < 2 || excess <= most) continue;
      richest = other;
      most = excess;
    }
    if (richest == part) return;
    --quota[richest];
    ++quota[part];
  }
}

// "17, 4 and 3", "0.7, 0.15 and 0.15".
template <class Number>
std::string SharesText(const PerPart<Number>& numbers) {
  return NumberText(numbers[0]) + ", " + NumberText(numbers[1]) + " and " + NumberText(numbers[2]);
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

PerPart<std::uint32_t> QuotaOf(const PerPart<double>& shares, std::uint32_t num) {
  // What decimal fractions lack of whole numbers by rounding is no remainder.
  constexpr double kRounding = 1e-9;
  PerPart<std::uint32_t> quota{};
  PerPart<double> remainders{};
  for (std::size_t part = 0; part < kNumSplits; ++part) {
    const double exact = shares[part] * num;
    quota[part] = static_cast<std::uint32_t>(std::floor(exact + kRounding));
    remainders[part] = exact - quota[part];
  }
  PerPart<std::size_t> order{};
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::ranges::greater(),
                           [&](std::size_t part) { return remainders[part]; });
  const std::uint32_t num_given = std::accumulate(quota.begin(), quota.end(), std::uint32_t{0});
  for (std::uint32_t i = 0; i < num - num_given; ++i) ++quota[order[i % kNumSplits]];
  FillEmptyParts(shares, num, quota);
  return quota;
}

bool HoldsShares(const PerPart<double>& shares, std::uint32_t num) {
  constexpr double kRounding = 1e-9;
  const PerPart<std::uint32_t> quota = QuotaOf(shares, num);
  for (std::size_t part = 0; part < kNumSplits; ++part) {
    if ((shares[part] > 0.0) != (quota[part] > 0)) return false;
    const double share = static_cast<double>(quota[part]) / num;
    if (std::abs(share - shares[part]) > kShareTolerance + kRounding) return false;
  }
  return true;
}

std::optional<std::string> QuotaFault(const PerPart<double>& shares, std::uint32_t num) {
  if (HoldsShares(shares, num)) return std::nullopt;
  std::uint32_t more = num + 1;
  while (!HoldsShares(shares, more)) ++more;
  std::uint32_t fewer = num - 1;
  while (fewer > 0 && !HoldsShares(shares, fewer)) --fewer;
  const std::string able = fewer == 0 ? NumberText(more) + " does"
                                      : NumberText(fewer) + " and " + NumberText(more) + " do";
  return "must divide into train, val and test of " + SharesText(shares) + " within " +
         NumberText(kShareTolerance) + ", as " + able + " (got " + NumberText(num) +
         ", at best divided into " + SharesText(QuotaOf(shares, num)) + ")";
}

std::uint32_t Permuted(std::uint32_t index, std::uint32_t size, std::uint64_t key) {
  if (size < 2) return index;
  constexpr std::uint32_t kNumRounds = 6;
  const auto half_bits = static_cast<std::uint32_t>((std::bit_width(size - 1) + 1) / 2);
  const std::uint64_t mask = (std::uint64_t{1} << half_bits) - 1;
  std::uint64_t place = index;
  do {
    std::uint64_t left = place >> half_bits;
    std::uint64_t right = place & mask;
    for (std::uint32_t round = 0; round < kNumRounds; ++round) {
      const std::uint32_t word =
          RandomWords(key, RandomUse::kDatasetDraw, round, static_cast<std::uint32_t>(right))[0];
      const std::uint64_t next = left ^ (word & mask);
      left = right;
      right = next;
    }
    place = (left << half_bits) | right;
  } while (place >= size);
  return static_cast<std::uint32_t>(place);
}

}  // namespace railcast
