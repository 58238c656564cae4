#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "core/base/text.h"
#include "core/io/run/sequence_files.h"

namespace railcast {

// The names of the files of a data set (docs/dataset.md), relative to its folder.

inline constexpr std::string_view kDatasetFile = "dataset.json";
inline constexpr std::string_view kRecipeFile = "recipe.json";
inline constexpr std::string_view kScenariosFile = "scenarios.jsonl";
inline constexpr std::string_view kIndexFile = "index.jsonl";
inline constexpr std::string_view kIndexDatabaseFile = "index.sqlite";  ///< Examples make it.
inline constexpr std::string_view kReportFile = "report.json";
inline constexpr std::string_view kDatasetManifestFile = "manifest.json";
inline constexpr std::string_view kSequencesFolder = "sequences";
/// In the folder of a scenario that is a plan: its recording with what was inserted.
inline constexpr std::string_view kRecordingFolder = "recording";
/// Beside it: the file with a line for each frame, which makes the frame count as done.
inline constexpr std::string_view kInsertFile = "insert.jsonl";
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

/// The rule that a text breaks if ParseShard() returns nothing; empty if it breaks none.
[[nodiscard]] std::string ShardRule(const std::string& text);

/// The shard as ParseShard() reads it.
[[nodiscard]] std::string ShardText(const Shard& shard);

// The bins in which report.json of a data set (docs/dataset.md) and `railcast-analyze stats` count,
// with their names.

/// Limits of the bins of distance, the first of which begins at 0 and the last of which has no end.
inline constexpr std::array<double, 7> kBinDistances_m = {10, 25, 50, 75, 100, 150, 200};
inline constexpr std::size_t kNumDistanceBins = kBinDistances_m.size() + 1;

/// Limits of the bins of occlusion; everything else is the last bin: not visible even alone.
inline constexpr std::array<double, 4> kBinOcclusions = {0.25, 0.5, 0.75, 1.0};
inline constexpr std::array<std::string_view, 6> kOcclusionBinNames = {
    "less than 0.25", "0.25 to 0.5", "0.5 to 0.75", "0.75 to 1", "1", "not visible"};
inline constexpr std::size_t kNumOcclusionBins = kOcclusionBinNames.size();

/// Index of the first limit above the value; the number of limits if there is none.
template <std::size_t kCount>
[[nodiscard]] std::size_t BinOf(const std::array<double, kCount>& limits, double value) {
  return static_cast<std::size_t>(std::ranges::upper_bound(limits, value) - limits.begin());
}

/// "0 to 10", ..., "200 and more", in metres.
[[nodiscard]] inline std::string DistanceBinText(std::size_t bin) {
  const std::string from = bin == 0 ? "0" : NumberText(kBinDistances_m.at(bin - 1));
  return bin < kBinDistances_m.size() ? from + " to " + NumberText(kBinDistances_m.at(bin))
                                      : from + " and more";
}

/// "0 to 10 m", ..., "200 m and more", as in report.json.
[[nodiscard]] inline std::string DistanceBinName(std::size_t bin) {
  if (bin < kBinDistances_m.size()) return DistanceBinText(bin) + " m";
  return NumberText(kBinDistances_m.back()) + " m and more";
}

}  // namespace railcast
