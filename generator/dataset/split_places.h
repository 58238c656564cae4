#pragma once

#include <optional>
#include <string>
#include <vector>

#include "generator/dataset/keyed_draws.h"
#include "generator/dataset/recipe.h"
#include "generator/dataset/split_quota.h"

namespace railcast {

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
