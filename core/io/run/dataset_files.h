#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "core/base/text.h"
#include "core/io/run/sequence_files.h"

namespace railcast {

// The names of the files of a data set (docs/dataset.md), relative to its folder.

inline constexpr std::string_view kDatasetFile = "dataset.json";
inline constexpr std::string_view kSequencesFolder = "sequences";
/// In the folder of a scenario that is a plan: its recording with what was inserted.
inline constexpr std::string_view kRecordingFolder = "recording";
/// In the same folder: the file with a line for each frame, which makes the frame count as done.
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
