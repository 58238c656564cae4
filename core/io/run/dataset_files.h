#pragma once

#include <array>
#include <cstdint>
#include <optional>
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

/// The part of a data set that one run makes: every `of`-th scenario, beginning with number - 1.
struct Shard {
  /// More would each hold hardly anything.
  static constexpr std::uint32_t kMost = 100'000;

  std::uint32_t number = 1;  ///< From 1 to `of`.
  std::uint32_t of = 1;      ///< 1 to kMost.

  [[nodiscard]] bool is_whole() const { return of == 1; }
  /// Number of its scenarios.
  [[nodiscard]] std::uint32_t NumOf(std::uint32_t num_scenarios) const {
    return num_scenarios < number ? 0 : (num_scenarios - number) / of + 1;
  }
  /// Its i-th scenario.
  [[nodiscard]] std::uint32_t ScenarioAt(std::uint32_t i) const { return number - 1 + i * of; }
};

/// Parses "2/7"; returns nothing if the text is not such a shard.
[[nodiscard]] std::optional<Shard> ParseShard(std::string_view text);

/// The shard as ParseShard() reads it.
[[nodiscard]] std::string ShardText(const Shard& shard);

}  // namespace railcast
