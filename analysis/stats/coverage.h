#pragma once

#include <cstdint>
#include <vector>

#include "analysis/estimate/streams.h"
#include "analysis/report/report.h"
#include "core/io/recording/scan_table.h"
#include "railcast/io/recording.h"

namespace railcast {

/// Where the points are: number per frame, by ring and azimuth, and the ground area they
/// cover.
class Coverage {
 public:
  /// @param scan Null if the frame is not a grid.
  void Add(const RecordedFrame& recorded, const ScanTable* scan);
  void Add(const Coverage& other);
  void ForgetRings() { rings_.clear(); }

  [[nodiscard]] std::uint64_t num_frames() const { return points_.num(); }
  [[nodiscard]] std::uint64_t num_points() const { return num_points_; }
  /// Mean over frames.
  [[nodiscard]] Estimate PointsPerFrame() const { return points_.Mean(); }
  /// Number of 1 m squares, seen from above, with at least one point; mean over frames.
  [[nodiscard]] Estimate OccupiedCells() const { return cells_.Mean(); }
  [[nodiscard]] Section MakeSection() const;

 private:
  struct Ring {
    Moments elevation_deg;
    std::uint64_t num_firings{};
    std::uint64_t num_points{};
  };

  std::uint64_t num_points_{};
  Moments points_, cells_;  ///< Per frame.
  std::vector<Ring> rings_;
  std::vector<std::uint64_t> sectors_;  ///< Points by azimuth, 5 deg each from -180.
};

}  // namespace railcast
