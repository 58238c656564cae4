#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "analysis/extras/rare/rare_event.h"
#include "analysis/extras/study/approach_record.h"
#include "analysis/extras/study/run_study.h"
#include "analysis/report/report.h"
#include "core/extras/recipe/scenario_draw.h"

namespace railcast {

/// Something that a recipe draws, as a factor of rare failures.
struct RecipeFactor {
  std::string name{};   ///< The name of its draw (KeyedDraws).
  std::string shown{};  ///< As studies name it: "weather", "/weather/visibility_m", "person /d_m".
  Distribution distribution{};  ///< For a group, a choice between the names of its options.
  RareFactor law{};
};

/// The groups and draws of a recipe, and the draws of its objects. Which base is taken, where the
/// vehicle starts, how many objects there are and how far ahead, seeds and random weather are no
/// factors: they stay as they are drawn.
[[nodiscard]] std::vector<RecipeFactor> FactorsOfRecipe(const Recipe& recipe);

/// What the recipe's draws are given so that they have the values of a point.
[[nodiscard]] GivenQuantiles QuantilesAt(const std::vector<RecipeFactor>& factors,
                                         const RarePoint& point);

/// A run that seeks rare failures in the approaches of a study.
struct RareStudy {
  std::vector<RecipeFactor> factors{};
  std::string cheap{};  ///< Rungs; both the same where there is one level only.
  std::string dear{};
  RareRun run{};                             ///< The run of all approaches.
  std::vector<ApproachRecord> approaches{};  ///< By number; of pairs, those on the dear rung.
  std::uint32_t num_made{};                  ///< By this run.
  /// Processor time of an approach on the cheap rung, and of one on both; NaN if this run has made
  /// none.
  std::array<double, 2> approach_s{};
  StudyRecord identity{};
};

/// The scenario of an approach, on the dear rung.
[[nodiscard]] DrawnScenario DrawRare(const RareStudy& study,
                                     const ScenarioDrawer& drawer,
                                     std::uint32_t number);

/// Estimates with which probability something in the way is not detected in time in an approach.
/// Each approach has the number of its trial; its lines are those of a study.
/// @pre study.rare is given, and all of its approaches are asked for: no shards.
/// @return Nothing if it was stopped.
/// @throws InputError as RunStudy() does.
[[nodiscard]] std::optional<RareStudy> RunRareStudy(const StudySpec& study,
                                                    const ScenarioDrawer& drawer,
                                                    const StudyChoices& choices,
                                                    const StudyHooks& hooks);

/// The figure, what it rests on and cost, and the conditions of the failures. Defined in
/// rare_report.cpp.
[[nodiscard]] std::vector<Section> RareSections(const RareStudy& study);

}  // namespace railcast
