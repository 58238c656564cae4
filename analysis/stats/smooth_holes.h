#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "analysis/report/report.h"
#include "analysis/stats/bins.h"
#include "railcast/frame.h"

namespace railcast {

/// Firings that should have met a surface, and those of them without a point.
struct HoleCount {
  std::uint64_t num_expected{};
  std::uint64_t num_missing{};

  void Add(const HoleCount& other) {
    num_expected += other.num_expected;
    num_missing += other.num_missing;
  }
};

/// Holes in smooth surfaces of one brightness, by that brightness: what the sensor loses where the
/// surface gives no reason but its darkness. Edges, plants and patterns are left out.
class SmoothHoles {
 public:
  /// Counts a firing if the four points on either side of it in its ring lie on a line over their
  /// columns (standard deviation of the ranges up to 3 cm) and have intensities up to 1 that differ
  /// by no more than a factor of 1.5 and a step of 0.01.
  /// @pre `frame` is a grid.
  void AddFiring(const Frame& frame, std::size_t row, std::size_t column);
  void Add(const SmoothHoles& other) { AddEach(by_intensity_, other.by_intensity_); }

  /// By bin of Intensities(), of the mean intensity of the eight points; may be empty.
  [[nodiscard]] const std::vector<HoleCount>& by_intensity() const { return by_intensity_; }
  /// Bins of intensity, narrow where it is dark.
  [[nodiscard]] static const Bins& Intensities();
  [[nodiscard]] Table MakeTable() const;

 private:
  std::vector<HoleCount> by_intensity_;
};

}  // namespace railcast
