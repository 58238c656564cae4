#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "core/io/run/sequence_files.h"

namespace railcast {

// The names of the files of a data set (docs/dataset.md), relative to its folder.

inline constexpr std::string_view kDatasetFile = "dataset.json";
inline constexpr std::string_view kRecipeFile = "recipe.json";
inline constexpr std::string_view kScenariosFile = "scenarios.jsonl";
inline constexpr std::string_view kIndexFile = "index.jsonl";
inline constexpr std::string_view kIndexDatabaseFile = "index.sqlite";
inline constexpr std::string_view kReportFile = "report.json";
inline constexpr std::string_view kDatasetManifestFile = "manifest.json";
inline constexpr std::string_view kSequencesFolder = "sequences";
inline constexpr std::array<std::string_view, 3> kSplitFiles = {"split/train.txt", "split/val.txt",
                                                                "split/test.txt"};

/// The folder of a scenario's sequence, a thousand in one folder: "sequences/012/012345".
[[nodiscard]] inline std::string SequenceFolderOf(std::uint32_t scenario) {
  constexpr std::size_t kDigitsWithin = 3;
  const std::string digits = FrameDigits(scenario);
  return std::string(kSequencesFolder) + "/" + digits.substr(0, digits.size() - kDigitsWithin) +
         "/" + digits;
}

}  // namespace railcast
