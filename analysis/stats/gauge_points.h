#pragma once

#include <array>
#include <cstdint>
#include <map>

#include "analysis/report/report.h"
#include "analysis/stats/names.h"
#include "core/io/cloud/track_fields.h"
#include "core/io/run/dataset_files.h"
#include "railcast/io/recording.h"

namespace railcast {

/// The points in the vehicle's outline on a given track, by label and range.
class GaugePoints {
 public:
  /// @param track Of the vehicle, in the world of the frame's pose.
  /// @throws InputError if the frame has no pose.
  void Add(const RecordedFrame& recorded, const FrameTrack& track);
  void Add(const GaugePoints& other);

  [[nodiscard]] bool is_empty() const { return num_frames_ == 0; }
  [[nodiscard]] Section MakeSection(const Names& names) const;

 private:
  using RangeCounts = std::array<std::uint64_t, kNumDistanceBins>;

  std::map<std::uint32_t, RangeCounts> in_gauge_;  ///< By label; 0 of clouds without.
  RangeCounts all_{};  ///< Points beside the track and beyond its ends, too.
  std::uint64_t num_frames_{};
  std::uint64_t num_frames_with_any_{};
};

}  // namespace railcast
