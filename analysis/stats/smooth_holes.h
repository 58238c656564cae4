#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

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
  /// columns (standard deviation of the ranges up to 3 cm) and have intensities up to 1, of which
  /// the highest is at most 1.5 times the lowest plus a step of 0.01.
  /// @pre `frame` is a grid.
  void AddFiring(const Frame& frame, std::size_t row, std::size_t column);
  void Add(const SmoothHoles& other) { AddEach(by_intensity_, other.by_intensity_); }

  struct Count {
    HoleCount firings;
    double sum_intensity{};  ///< Of the firings' neighbours.

    [[nodiscard]] double MeanIntensity() const {
      return sum_intensity / static_cast<double>(firings.num_expected);
    }
    void Add(const Count& other) {
      firings.Add(other.firings);
      sum_intensity += other.sum_intensity;
    }
  };
  /// By bin of Intensities(), of the mean intensity of the eight points; may be empty.
  [[nodiscard]] const std::vector<Count>& by_intensity() const { return by_intensity_; }
  /// Bins of intensity, narrow where it is dark, with edges between the whole percents in which
  /// sensors report it.
  [[nodiscard]] static const Bins& Intensities();

 private:
  std::vector<Count> by_intensity_;
};

}  // namespace railcast
