#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/extras/study/study_factors.h"
#include "analysis/extras/study/study_spec.h"
#include "core/extras/recipe/scenario_draw.h"

namespace railcast {

// What a finished study keeps beside its lines, so that its folder can be filed by itself: the
// study, its recipe, and the scenarios of some approaches.

inline constexpr std::string_view kWorstFolder = "worst";
/// Approaches spread over all of them, on which the model is compared with the reference.
inline constexpr std::string_view kSampleFolder = "sample";
/// "inputs/study.json", whose recipe is "inputs/recipe.json".
inline constexpr std::string_view kAskedFile = "inputs/study.json";
inline constexpr std::string_view kAskedRecipeFile = "inputs/recipe.json";

/// Where a scenario lies in the study's folder: "worst/000012".
[[nodiscard]] std::string KeptFolder(std::string_view folder, std::uint32_t scenario);

/// Numbers of at most 16 scenarios with observations, spread evenly over them.
[[nodiscard]] std::vector<std::uint32_t> SampleOf(const std::vector<Observation>& observations);

/// Draws the scenario of an approach.
using DrawByNumber = std::function<DrawnScenario(std::uint32_t number)>;

/// Writes the scenarios of the worst and those of the sample, the study and its recipe, and
/// manifest.json with the hashes of these and of the study's own files.
/// @throws InputError if a file cannot be written.
void KeepFiles(const StudySpec& study,
               const DrawByNumber& draw,
               const std::vector<Observation>& worst,
               const std::vector<std::uint32_t>& sample,
               const std::filesystem::path& directory);

/// Checks that a study's files are as they were kept.
/// @return The scenarios of the sample, in the order of their numbers.
/// @throws InputError with a line for each file that is missing or was changed.
[[nodiscard]] std::vector<std::filesystem::path> CheckKeptFiles(
    const std::filesystem::path& directory);

}  // namespace railcast
