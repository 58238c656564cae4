#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <tuple>
#include <vector>

#include "analysis/report/report.h"
#include "analysis/stats/bins.h"
#include "analysis/stats/sums.h"
#include "railcast/frame.h"
#include "railcast/io/recording.h"

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
  static auto Sums(auto& of) { return std::tie(of.by_intensity_); }

  struct Count {
    HoleCount firings;
    double sum_intensity{};  ///< Over the firings' neighbours.

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

/// The range at which a firing should have met the surface that its two neighbours in its ring lie
/// on: their mean if they differ by less than 5 % (0.1 m is always allowed), else nothing.
/// @pre 0 < column < frame.columns - 1.
[[nodiscard]] std::optional<double> RangeBetweenNeighbours_m(const Frame& frame,
                                                             std::size_t row,
                                                             std::size_t column);

/// Dropout estimated from the points alone, for grids that do not say why a slot is empty.
///
/// A firing whose two neighbours in its ring lie on one surface (RangeBetweenNeighbours_m) should
/// have met that surface, too; if it has no point, it is a hole. The share of holes among such
/// firings is the dropout if losses are independent of each other; where they cluster (dark, far or
/// grazing patches) it is a lower bound. A sensor that is set to half a turn has no neighbours, and
/// so no holes, in the other half; its columns without any point are also excluded from the share
/// of firings with a point. Firings that are known to have met the own vehicle are excluded from
/// both, since the scene has lost nothing there.
class Holes {
 public:
  /// Frames that are not grids are skipped.
  void Add(const RecordedFrame& recorded);
  static auto Sums(auto& of) {
    return std::tie(of.num_firings_, of.num_points_, of.all_, of.groups_, of.smooth_);
  }
  void ForgetRings() { has_rings_ = false; }

  using Count = HoleCount;

  [[nodiscard]] bool is_empty() const { return num_firings_ == 0; }
  [[nodiscard]] Estimate Share() const { return Proportion(all_.num_missing, all_.num_expected); }
  /// Share of all firings, including those into the sky, with a point.
  [[nodiscard]] Estimate Filled() const { return Proportion(num_points_, num_firings_); }
  [[nodiscard]] Section MakeSection() const;

 private:
  void AddFiring(const Frame& frame, std::size_t row, std::size_t column);

  std::uint64_t num_firings_{};  ///< In columns with points.
  std::uint64_t num_points_{};
  Count all_;
  Grouped<Count> groups_;  ///< These by range and ring.
  bool has_rings_ = true;
  SmoothHoles smooth_;
};

}  // namespace railcast
