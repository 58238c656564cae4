#include "core/rail/structures/lineside_placing.h"

#include "core/rail/base/model_parts.h"
#include "core/rail/structures/standing_height.h"

namespace railcast {

void AppendModel(const Model& model, const Transform& chunk_from_model, Chunk& chunk) {
  for (const Part& part : model.parts) {
    MeshOf({.material = part.material, .label = part.label}, chunk.ground)
        .Append(part.mesh, chunk_from_model);
  }
}

Transform AtTopOfRail(const StructureTrack& track, const LinesidePlace& place) {
  Transform pose = track.Upright(place.s_m);
  pose.translation() = pose * Vector3(0.0, place.d_m, 0.0);
  return pose * Eigen::AngleAxisd(place.yaw_rad, Vector3::UnitZ());
}

Transform OnGround(const ChunkContext& context,
                   const StructureTrack& track,
                   const LinesidePlace& place,
                   const Model& model) {
  const Eigen::AlignedBox3d bounds_m = model.Bounds();
  const StandingPlace standing{.s_m = place.s_m,
                               .d_m = track.offset_m(place.s_m) + place.d_m,
                               .heading_rad = place.yaw_rad,
                               .area_m = {bounds_m.min().head<2>(), bounds_m.max().head<2>()}};
  Transform pose = AtTopOfRail(track, place);
  // A chunk's frame is turned about the vertical only.
  pose.translation().z() =
      StandingHeight_m(context, standing) + context.chunk_from_world.translation().z();
  return pose;
}

}  // namespace railcast
