#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/extras/recipe/dataset_record.h"
#include "core/extras/recipe/distribution.h"
#include "core/extras/recipe/recipe.h"
#include "core/extras/recipe/recipe_files.h"
#include "core/extras/recipe/split_plan.h"
#include "railcast/scenario.h"

namespace railcast {

/// A scenario of a recipe.
struct DrawnScenario {
  ScenarioSpec scenario;  ///< With the sensors of which frames are made; or a plan.
  /// For a plan, the recording that it is for and the frames that it is put into; else null.
  std::shared_ptr<const RecordedBase> run{};
  std::uint32_t first_frame{};
  std::uint32_t num_frames{};
  /// What a data set says of it, but for its sequences.
  ScenarioRecord record{};
};

/// Draws the scenarios of a recipe. Each depends on the recipe and its number alone.
class ScenarioDrawer {
 public:
  /// @param recipe Must outlive the drawer.
  /// @throws InputError with the faults of the bases, or as SplitPlan does.
  explicit ScenarioDrawer(const Recipe& recipe)
      : recipe_(recipe), bases_(recipe), plan_(recipe, bases_) {}

  /// @param number May exceed those of the recipe.
  /// @param given Of values that are given instead of drawn (KeyedDraws).
  /// @throws InputError that names the recipe's key if the scenario is faulty or something finds no
  ///   place in it.
  [[nodiscard]] DrawnScenario Draw(std::uint32_t number, const GivenQuantiles& given = {}) const;

  [[nodiscard]] const Recipe& recipe() const { return recipe_; }
  [[nodiscard]] const RecipeBases& bases() const { return bases_; }

 private:
  const Recipe& recipe_;
  RecipeBases bases_;
  SplitPlan plan_;
};

}  // namespace railcast
