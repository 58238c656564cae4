#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/extras/recipe/recipe.h"
#include "core/extras/recipe/recipe_files.h"
#include "core/extras/recipe/seen_stretch.h"
#include "core/extras/recipe/split_quota.h"
#include "core/scenario/json_text.h"

namespace railcast {

/// Names a line: the hash of the alignment of a resolved scenario.
[[nodiscard]] std::string LineHash(const Json& scenario);

/// Which parts the scenarios of a recipe, and the places where they are, belong to. A function of
/// the recipe and its bases alone, so that all shards have the same.
///
/// A scenario's part follows from its number, so that the parts have the shares that the recipe
/// asks for, to the nearest scenario. Its base and its start are then drawn from the places of that
/// part.
class SplitPlan {
 public:
  /// @throws InputError that names the recipe's key if a part has no place in which a scenario
  ///   fits.
  SplitPlan(const Recipe& recipe, const RecipeBases& bases);

  [[nodiscard]] Split PartOf(std::uint32_t scenario) const;

  /// How often each base is drawn for the scenarios of a part, relative to the others.
  [[nodiscard]] const std::vector<double>& BaseWeights(Split part) const {
    return base_weights_.at(static_cast<std::size_t>(part));
  }

  /// The part to which all of a stretch of a base's line belongs; nothing if it belongs to several.
  /// @pre Places are what is not divided.
  [[nodiscard]] std::optional<Split> PartOf(std::size_t base, const SeenStretch& stretch) const;

 private:
  /// The parts of the cells of a line in which scenarios start.
  using CellParts = std::map<std::int64_t, Split>;

  void DivideLines(const RecipeBases& bases);
  void DivideCells(const RecipeBases& bases);
  [[nodiscard]] std::int64_t CellAt(double s_m) const;

  const Recipe& recipe_;
  PerPart<std::uint32_t> quota_{};
  std::uint64_t key_{};
  PerPart<std::vector<double>> base_weights_;
  std::map<std::string, CellParts> lines_;
  std::vector<const CellParts*> line_of_base_;
};

}  // namespace railcast
