#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "analysis/extras/study/run_study.h"
#include "analysis/extras/study/study_spec.h"
#include "core/scenario/json_text.h"
#include "railcast/scenario.h"

namespace railcast {

/// A study that was made, read from its folder alone.
struct FinishedStudy {
  std::filesystem::path directory;
  StudySpec spec;                     ///< As kept in the folder.
  Json recipe;                        ///< As kept in the folder; what it names need not exist.
  StudyResult result;                 ///< Without times.
  std::vector<std::uint32_t> frames;  ///< The frames of each approach.
  std::vector<std::filesystem::path> sample;  ///< Files of scenarios, a sample of all.
};

/// Reads the folder of a study.
/// @throws InputError if it holds none, if the study is a shard or unfinished, if another version
///   of railcast made it, or if a file is damaged.
[[nodiscard]] FinishedStudy ReadFinishedStudy(const std::filesystem::path& directory);

/// Reads the scenarios that a study keeps as a sample of all, by rising number.
/// @throws InputError if there are none, or as ReadScenario() does.
[[nodiscard]] std::vector<ScenarioSpec> ReadSample(const FinishedStudy& study);

}  // namespace railcast
