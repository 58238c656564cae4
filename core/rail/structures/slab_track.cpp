#include "core/rail/base/model_parts.h"
#include "core/rail/structures/structure_track.h"
#include "core/rail/structures/structure_types.h"
#include "core/rail/structures/swept_solid.h"
#include "core/rail/track/cross_section.h"

namespace railcast {
namespace {

/// The slab's top lies below the sleepers' rail seats (0.182 m below top of rail) and above their
/// middle (0.221 m).
constexpr double kSlabTop_m = -0.205;
constexpr double kSlabThickness_m = 0.24;
constexpr double kBaseWider_m = 0.3;  ///< The bound layer below, on each side.

}  // namespace

void AddStructure(const ChunkContext& context, const SlabTrackSpec& slab, Chunk& chunk) {
  const StructureTrack track(context, slab.track);
  const double half_m = 0.5 * slab.width_m;
  const auto stretch = StretchInChunk(track, {.begin_s_m = slab.begin_s_m, .end_s_m = slab.end_s_m},
                                      half_m, [&](double s_m) { return track.Canted(s_m); });
  if (!stretch) return;
  const double step_m = kSlabTop_m - kSlabThickness_m;
  const double foot_m = -CrossSection::kFormationDepth_m - 0.3;
  const double base_m = half_m + kBaseWider_m;
  const Outline outline_m{{-half_m, kSlabTop_m}, {half_m, kSlabTop_m}, {half_m, step_m},
                          {base_m, step_m},      {base_m, foot_m},     {-base_m, foot_m},
                          {-base_m, step_m},     {-half_m, step_m}};
  AppendSweptSolid(*stretch, outline_m,
                   MeshOf(context.surfaces.structures.slab_track, chunk.ground));
}

std::vector<ClearedArea> ClearedBy(const SlabTrackSpec& slab) {
  const double half_m = 0.5 * slab.width_m + kBaseWider_m;
  return {{.begin_s_m = slab.begin_s_m,
           .end_s_m = slab.end_s_m,
           .right_m = -half_m,
           .left_m = half_m,
           .cleared = {Clearing::kBallast, Clearing::kGrass}}};
}

}  // namespace railcast
