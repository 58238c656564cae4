#pragma once

#include <Eigen/Geometry>

#include "core/rail/chunk/chunk_context.h"
#include "core/rail/structures/structure_track.h"
#include "railcast/scene.h"
#include "railcast/transform.h"

namespace railcast {

/// A place beside a track, for what stands upright.
struct LinesidePlace {
  double s_m{};
  double d_m{};      ///< Left of the track's axis.
  double yaw_rad{};  ///< Counterclockwise from the direction of increasing chainage.
};

/// Upright at the height of top of rail of the track's axis.
[[nodiscard]] Transform AtTopOfRail(const StructureTrack& track, const LinesidePlace& place);
/// Upright on the ground, where the model's footprint is lowest.
[[nodiscard]] Transform OnGround(const ChunkContext& context,
                                 const StructureTrack& track,
                                 const LinesidePlace& place,
                                 const Model& model);

/// A place on the line for an object that stands on the ground.
struct StandingPlace {
  double s_m{};                ///< Chainage of its middle.
  double d_m{};                ///< Lateral position of its middle, left of the alignment's axis.
  double heading_rad{};        ///< Counterclockwise from the direction of increasing chainage.
  Eigen::AlignedBox2d area_m;  ///< Footprint about its middle; x forward, y left.
};

/// World height of the foot of a standing object: the ground, the ballast or the floor of a
/// structure (roads of level crossings, tops of platforms), whichever is higher, at the lowest of
/// its middle and corners. On a slope it may sink in slightly, but no part of it hovers. The grain
/// of the ballast is ignored.
[[nodiscard]] double StandingHeight_m(const ChunkContext& context, const StandingPlace& place);

/// The plane on which an object lies on sloping ground.
struct SlopeBelow {
  double height_m{};  ///< In the world, below the object's origin.
  Vector3 up;         ///< Its unit normal in the object's frame, were that upright.
};

/// The plane through the ground below the object's corners (least squares), lowered until it is
/// nowhere above the ground at its corners and its middle, so that no part hovers on rough ground.
[[nodiscard]] SlopeBelow SlopeBelowObject(const ChunkContext& context, const StandingPlace& place);

}  // namespace railcast
