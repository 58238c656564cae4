#include "generator/dataset/split_quota.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "core/base/random.h"
#include "core/base/text.h"

namespace railcast {
namespace {

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
