#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "generator/dataset/recipe.h"

namespace railcast {

inline constexpr std::size_t kNumSplits = kEnumNames<Split>.size();

/// A number for each part, by Split.
template <class Number>
using PerPart = std::array<Number, kNumSplits>;

/// The shares that a recipe asks for.
[[nodiscard]] inline PerPart<double> SharesOf(const SplitSpec& split) {
  return {split.train, split.val, split.test};
}

/// The whole numbers of sum `num` that are nearest to the shares, by the method of largest
/// remainders (Hamilton). A part that has a share gets at least 1, if there are as many as parts.
[[nodiscard]] PerPart<std::uint32_t> QuotaOf(const PerPart<double>& shares, std::uint32_t num);

/// How far a share may be from what a recipe asks for: two points.
inline constexpr double kShareTolerance = 0.02;

/// Whether so many scenarios can be divided so that each part has its share within the tolerance.
[[nodiscard]] bool HoldsShares(const PerPart<double>& shares, std::uint32_t num);

/// What is wrong with a number of scenarios that cannot be divided so, with the nearest numbers
/// that can; nothing if it can.
[[nodiscard]] std::optional<std::string> QuotaFault(const PerPart<double>& shares,
                                                    std::uint32_t num);

/// The place of an element after a random permutation of `size` elements. It takes no memory and
/// gives each element by itself: a Feistel network whose results beyond the elements are permuted
/// again (Black, Rogaway 2002, "Ciphers with arbitrary finite domains").
/// @pre index < size
[[nodiscard]] std::uint32_t Permuted(std::uint32_t index, std::uint32_t size, std::uint64_t key);

}  // namespace railcast
