#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/scenario/json_text.h"
#include "generator/dataset/recipe.h"
#include "generator/dataset/recipe_files.h"
#include "generator/dataset/split_plan.h"
#include "railcast/scenario.h"

namespace railcast {

/// A scenario of a recipe.
struct DrawnScenario {
  ScenarioSpec scenario;  ///< With the sensors of which frames are made.
  /// What index and report say of it: scenario, base, split, place, seed, start_s_m, drawn,
  /// objects, weather.
  Json record;
};

/// Draws the scenarios of a recipe. Each depends on the recipe and its number alone.
class ScenarioDrawer {
 public:
  /// @param recipe Must outlive the drawer.
  /// @throws InputError with the faults of the bases, or as SplitPlan does.
  explicit ScenarioDrawer(const Recipe& recipe)
      : recipe_(recipe), bases_(recipe), plan_(recipe, bases_) {}

  /// @throws InputError that names the recipe's key if the scenario is faulty or something finds no
  ///   place in it.
  [[nodiscard]] DrawnScenario Draw(std::uint32_t number) const;

  [[nodiscard]] const RecipeBases& bases() const { return bases_; }

 private:
  const Recipe& recipe_;
  RecipeBases bases_;
  SplitPlan plan_;
};

}  // namespace railcast
