#pragma once

#include <Eigen/Core>
#include <vector>

#include "railcast/alignment.h"

namespace railcast {

/// Track dimensions, docs/physics.md 7.1.
inline constexpr double kGauge_m = kStandardGauge_mm / 1000.0;
/// How much farther from the axis each rail of a line lies than on standard gauge.
[[nodiscard]] inline double RailShift_m(const AlignmentSpec& line) {
  return 0.5e-3 * (line.gauge_mm - kStandardGauge_mm);
}
/// Depth below top of rail at which the gauge is measured.
inline constexpr double kGaugeDepth_m = 0.014;
inline constexpr double kRailHeight_m = 0.172;
inline constexpr double kRailInclination = 1.0 / 40.0;
/// The sleepers of every track are placed at integer multiples of this chainage.
inline constexpr double kSleeperSpacing_m = 0.6;
inline constexpr double kSleeperHalfLength_m = 1.3;

/// The 60E1 section of one rail in position: (y, z) in the track frame, inclined 1:40 towards the
/// middle of the track, with its highest point at top of rail and its gauge face half a gauge from
/// the axis. Based on the half section polygon of docs/physics.md 7.1 (+-1 mm; area 77.07 cm^2).
struct RailSection {
  /// From one bottom corner of the foot over the head to the other, clockwise with y to the right
  /// and z up. Point i mirrors point size - 1 - i.
  std::vector<Eigen::Vector2d> outline_m;
  std::size_t head_first{};  ///< Index where the running band, 52 mm wide, begins ...
  /// ... and where it ends.
  std::size_t head_last{};
};

/// The section of the left or right rail.
[[nodiscard]] RailSection MakeRailSection(bool left);

/// The middle of the underside of the rail foot, (y, z) for the left rail.
[[nodiscard]] Eigen::Vector2d RailFootMiddle_m();

}  // namespace railcast
