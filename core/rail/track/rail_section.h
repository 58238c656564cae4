#pragma once

#include <Eigen/Core>
#include <vector>

namespace railcast {

/// Track dimensions, physics.md 7.1.
inline constexpr double kGauge_m = 1.435;
inline constexpr double kGaugeDepth_m = 0.014;  ///< Below top of rail, where gauge is measured.
inline constexpr double kRailHeight_m = 0.172;
inline constexpr double kRailInclination = 1.0 / 40.0;

/// The 60E1 section of one rail in place: (y, z) of the track frame, inclined 1:40 towards the
/// track's middle, its highest point at top of rail, its gauge face half a gauge from the axis.
/// From the half section polygon of physics.md 7.1 (+-1 mm; area 77.07 cm^2).
struct RailSection {
  /// From the foot's one bottom corner over the head to the other, clockwise with y to the right
  /// and z up. Point i mirrors point size - 1 - i.
  std::vector<Eigen::Vector2d> outline_m;
  std::size_t head_first{};  ///< The running band, 52 mm wide, lies between these two points.
  std::size_t head_last{};
};

/// Of the left rail, or of the right one.
[[nodiscard]] RailSection MakeRailSection(bool left);

/// Where the middle of the rail foot's underside is, (y, z) for the left rail.
[[nodiscard]] Eigen::Vector2d RailFootMiddle_m();

}  // namespace railcast
