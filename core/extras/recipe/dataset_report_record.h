#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>

#include "core/io/run/dataset_files.h"
#include "core/io/run/frame_record.h"

namespace railcast {

// report.json of a data set (docs/dataset.md).

/// Numbers by name.
using CountsByName = std::map<std::string, std::uint64_t>;

/// Counts of a part of the data set.
struct SplitCountsRecord {
  std::uint64_t scenarios{};
  std::uint64_t frames{};
  std::uint64_t points{};
};
void Describe(Archive& a, SplitCountsRecord& s);

/// Counts of the points with a label.
struct LabelCountsRecord {
  std::uint64_t points{};
  double share{};  ///< Share of all points.
  std::uint64_t frames{};
};
void Describe(Archive& a, LabelCountsRecord& s);

/// By the bins of distance.
struct DistanceCounts : std::array<std::uint64_t, kNumDistanceBins> {
  DistanceCounts() : array() {}
};
void Describe(Archive& a, DistanceCounts& s);

/// By the bins of occlusion, of which the last is: not visible even alone.
struct OcclusionCounts : std::array<std::uint64_t, kNumOcclusionBins> {
  OcclusionCounts() : array() {}
};
void Describe(Archive& a, OcclusionCounts& s);

/// Counts of the objects of one type. All but `objects` count an object in each frame.
struct TypeCountsRecord {
  std::uint64_t objects{};  ///< Distinct ones.
  std::uint64_t in_frames{};
  std::uint64_t with_points{};
  std::uint64_t points{};
  DistanceCounts by_distance{};
  DistanceCounts points_by_distance{};
  OcclusionCounts by_occlusion{};
};
void Describe(Archive& a, TypeCountsRecord& s);

/// The content of report.json. Its sums agree (Describe()).
struct DatasetReportRecord {
  std::uint64_t num_frames{};
  std::map<std::string, SplitCountsRecord> splits{};
  std::uint64_t frames_without_points{};
  std::uint64_t frames_without_objects{};
  std::uint64_t duplicate_frames{};  ///< Frames that repeat the bytes of another frame.
  FrameCounts counts{};
  std::map<std::string, LabelCountsRecord> labels{};
  std::map<std::string, TypeCountsRecord> objects{};
  CountsByName weathers{};                      ///< Scenarios.
  std::map<std::string, CountsByName> drawn{};  ///< Scenarios by the words of each draw.
  CountsByName frames_by_base{};
  CountsByName frames_by_sensor{};
};
void Describe(Archive& a, DatasetReportRecord& s);

}  // namespace railcast
