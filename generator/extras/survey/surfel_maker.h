#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "core/extras/survey/survey_file.h"
#include "generator/extras/survey/survey_voxels.h"

namespace railcast {

/// What a surfel is a piece of, by the spread of the points about it.
enum class SurfelKind : std::uint8_t {
  kSurface,
  kLinear,  ///< Points along a line: wires, rods, narrow poles.
  kOther,   ///< Points in all directions: leaves, edges.
};

struct SurfelRules {
  /// Where neighbouring points are farther apart than this, nothing is between them.
  double max_gap_m = 0.5;
  /// Size of a surfel as a multiple of what reaches half way to its neighbours.
  double size_factor = 1.5;
};

/// A surfel before it is put into a tile.
struct MadeSurfel {
  Vector3 center_m = Vector3::Zero();  ///< In the world.
  Eigen::Vector3f half_u_m = Eigen::Vector3f::Zero();
  Eigen::Vector3f half_v_m = Eigen::Vector3f::Zero();
  SurveySurface surface{};
  SurfelKind kind{};
  bool is_ground = false;   ///< Whether things may stand on it.
  bool is_sparse = false;   ///< Whether its neighbours are so far apart that only a wire has any.
  std::uint32_t voxel = 0;  ///< Index of the one that it was made of.

  [[nodiscard]] Eigen::Vector3f Normal() const { return half_u_m.cross(half_v_m).normalized(); }
};

/// Neighbouring points of a wire are at most so far apart.
inline constexpr float kLongestWireGap_m = 3.0F;

/// Makes a surfel of every voxel that has neighbours: a rectangle in the plane through the points
/// about it, which reaches half way to the nearest point on each of its four sides and ends where
/// there is none: where points are farther apart than the gap that is allowed, and than the
/// sensor's beams were. As in AdaSplats (Richa et al., Remote Sensing 14(24), 2022, 6262) the kind
/// decides how many neighbours determine the plane and how large the surfel is; unlike there, kinds
/// follow from the points' own spread, and a surfel is a rectangle instead of a disc, because scan
/// lines are denser along than across. In the order of tiles, and of voxels within a tile.
[[nodiscard]] std::vector<MadeSurfel> MakeSurfels(const SurveyVoxels& cloud,
                                                  const SurfelRules& rules);

/// The tile with a place of the world, added if there is none.
[[nodiscard]] SurveyTile& TileAt(const Vector3& place_m,
                                 std::map<std::array<std::int32_t, 2>, SurveyTile>& tiles);
/// Puts surfels and their ground into tiles, by their cells.
[[nodiscard]] std::map<std::array<std::int32_t, 2>, SurveyTile> TilesOf(
    const std::vector<MadeSurfel>& surfels);

}  // namespace railcast
