#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/extras/recipe/distribution.h"
#include "core/extras/recipe/recipe.h"

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

/// Ground that belongs to one part as a whole: a cell of a line, or a line.
struct SplitPlace {
  std::string name;             ///< Unique; its draw depends on it.
  double weight{};              ///< How often scenarios are there, relative to other places.
  std::optional<Split> pinned;  ///< The part that the recipe gives it.
};

/// Gives each place to a part, in random order, but such that the weights of the parts come near to
/// their shares, and that each part with a share gets a place.
/// @return The parts of the places; nothing if there are too few for that.
[[nodiscard]] std::optional<std::vector<Split>> DividePlaces(const std::vector<SplitPlace>& places,
                                                             const PerPart<double>& shares,
                                                             const KeyedDraws& draws);

}  // namespace railcast
