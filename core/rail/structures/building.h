#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/rail/base/rail_surfaces.h"
#include "railcast/scene.h"

namespace railcast {

/// What a building is made from.
struct BuildingShape {
  std::vector<Eigen::Vector2d> footprint_m;  ///< Corners in plan, in either direction round.
  double eaves_m{};                          ///< Height of the walls above the ground.
  /// Pitch of a gable roof over a footprint of four corners, with its ridge along the longer sides;
  /// absent = a flat roof.
  std::optional<double> gable_pitch_rad;
  bool has_windows = true;
};

/// Windows stand in rows, one for each full storey, on every wall long enough for one.
inline constexpr double kStorey_m = 3.0;
inline constexpr double kWindowWidth_m = 1.2;
inline constexpr double kWindowHeight_m = 1.4;
inline constexpr double kWindowSill_m = 0.9;      ///< Above the storey's floor.
inline constexpr double kWindowSpacing_m = 3.0;   ///< At least, between middles.
inline constexpr std::size_t kMostWindows = 150;  ///< Then they are farther apart.

/// A building in the frame of its footprint, with the ground at z = 0, into which its walls reach 1
/// m deep. Windows are panes 20 mm in front of the walls. Two triangles for each wall and window,
/// and two less than corners (flat) or six (gable) for the roof.
[[nodiscard]] Model MakeBuilding(const BuildingShape& shape, const LinesideSurfaces& surfaces);

/// Height of the ridge above the eaves; 0 of a flat roof.
[[nodiscard]] double RidgeRise_m(const BuildingShape& shape);

}  // namespace railcast
