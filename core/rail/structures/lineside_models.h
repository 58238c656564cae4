#pragma once

#include <Eigen/Core>
#include <optional>
#include <string_view>
#include <vector>

#include "core/rail/base/rail_surfaces.h"
#include "railcast/scene.h"

namespace railcast {

/// Lengths that a thing's row leaves open; lineside_models.cpp says which of them each thing needs.
struct LinesideSizes {
  double length_m{};  ///< Along x.
  double depth_m{};   ///< Along y.
  double height_m{};  ///< From its origin to its top.
  double shift_m{};   ///< How much farther from the middle the rails lie than on standard gauge.
};

/// A single thing beside or in the track, which is placed once or many times: a row of the table in
/// lineside_models.cpp.
///
/// Unless noted otherwise, a model stands upright with its origin at the middle of its footprint at
/// the height of top of rail. x is the direction of travel of the trains that it is for, so that
/// what they should see faces -x. Dimensions are those of docs/results/world_dimensions.md unless a
/// source is named. Posts reach down to kFoot_m, which is below the ground beside a track.
[[nodiscard]] Model MakeLinesideModel(std::string_view name,
                                      const LinesideSurfaces& surfaces,
                                      const LinesideSizes& sizes = {});
inline constexpr double kFoot_m = -1.0;

/// From a buffer stop's buffers to its end.
inline constexpr double kBufferStopLength_m = 2.5;

/// Width along y and height along z of a flat thing.
struct PlateSize {
  double width_m{};
  double height_m{};
};

/// A plate on a post of 60 mm: retroreflecting in front, steel behind. Its upper edge is `height_m`
/// above top of rail. 52 triangles.
[[nodiscard]] Model MakeBoard(const PlateSize& plate,
                              double height_m,
                              const LinesideSurfaces& surfaces);

/// As MakeBoard(), with a triangular plate that stands on its tip. 44 triangles.
[[nodiscard]] Model MakeTriangularBoard(const PlateSize& plate,
                                        double height_m,
                                        const LinesideSurfaces& surfaces);

/// A half barrier on the road's surface, where its origin is: pedestal, counterweight, and a boom
/// of that length from the pedestal's middle, in stripes of 0.6 m, red and retroreflecting white.
/// Closed, the boom lies along x, 0.95 m high. 36 triangles and 12 for each stripe.
/// @param angle_rad From 0 = closed to pi / 2 = upright.
[[nodiscard]] Model MakeHalfBarrier(double boom_length_m,
                                    double angle_rad,
                                    const LinesideSurfaces& surfaces);
/// Its boom with the counterweight, about its axis at the origin and closed. It turns by angle_rad
/// about y.
[[nodiscard]] Model MakeBoom(double length_m, const LinesideSurfaces& surfaces);
/// Height of a half barrier's axis, about which its boom turns, above the road.
inline constexpr double kBoomAxis_m = 0.95;
/// Turns a boom and puts it on its pedestal.
[[nodiscard]] Transform BarrierFromBoom(double angle_rad);

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
