#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "analysis/extras/study/approach_record.h"
#include "analysis/extras/study/study_directory.h"
#include "analysis/extras/study/study_spec.h"
#include "core/extras/recipe/recipe.h"
#include "core/extras/recipe/shard.h"
#include "core/scenario/json_text.h"

namespace railcast {

struct StudyChoices {
  std::filesystem::path directory{};
  Shard shard{};
  std::vector<std::filesystem::path> shards{};  ///< To be merged instead of simulated.
  int num_threads = 0;                          ///< 0 = all cores.
  std::string isa{};                            ///< As MakeSimulator() takes it.
  std::optional<double> certify{};  ///< Share of the time that certificates may take; or none.
};

struct StudyHooks {
  /// Called by one thread at a time.
  std::function<void(std::uint32_t num_done, std::uint32_t num_approaches)> on_progress;
  std::function<bool()> is_stopped;  ///< Called by several threads at once.
};

struct StudyResult {
  std::vector<ApproachRecord> approaches;  ///< All of the shard's that are done.
  std::uint32_t num_made{};                ///< By this run.
  std::uint32_t num_approaches{};          ///< Approaches of the shard.
  std::uint64_t num_frames{};              ///< Frames of the approaches made by this run.
  std::uint64_t num_traced{};              ///< Frames among them of which firings were traced.
  double elapsed_s{};
  StudyRecord identity;  ///< What the figures depend on: versions and hashes.

  [[nodiscard]] bool is_complete() const { return approaches.size() == num_approaches; }
};

/// Reads a recipe that is fit for a study: of scenarios with one sensor, on a rung that is named.
/// @throws InputError as ReadRecipe() does.
[[nodiscard]] Recipe ReadStudyRecipe(const StudySpec& study);

/// Where a scenario of a recipe is wrong: "recipe.json: scenario 7: ".
[[nodiscard]] std::string PlaceOfScenario(const Recipe& recipe, std::uint32_t number);

/// Checks what ScenarioDrawer does not, since data sets may have it.
/// @throws InputError if the rung is `auto`, or if there are several sensors.
void CheckIsStudied(const ScenarioSpec& scenario);

/// Makes an approach of a study. Called by several threads at once.
/// @return Nothing if it was stopped.
/// @throws InputError that names the recipe and the number, as ScenarioDrawer and ApproachScanner
/// do.
using ApproachMaker = std::function<std::optional<ApproachRecord>(
    const DrawnScenario& drawn, int num_threads, const std::function<bool()>& is_stopped)>;

/// @param study,recipe Must outlive the maker.
[[nodiscard]] ApproachMaker MakerOfApproaches(const StudySpec& study,
                                              const Recipe& recipe,
                                              const StudyChoices& choices);

/// What the figures of a study depend on.
/// @throws InputError if no scenario has what is asked about, as RunStudy() does.
[[nodiscard]] StudyRecord IdentityOfStudy(const StudySpec& study,
                                          const ScenarioDrawer& drawer,
                                          const StudyChoices& choices);

/// Makes the approaches that the folder does not hold yet, one on each thread.
/// @throws InputError as StudyDirectory, ScenarioDrawer and ApproachScanner do; if no scenario has
///   what is asked about, "study.json: /objects/1: must be an object of a scenario (got "wagon")".
[[nodiscard]] StudyResult RunStudy(const StudySpec& study,
                                   const ScenarioDrawer& drawer,
                                   const StudyChoices& choices,
                                   const StudyHooks& hooks);

}  // namespace railcast
