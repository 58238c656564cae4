#include <algorithm>

#include "core/rail/base/rail_surfaces.h"
#include "core/rail/line/rail_section.h"
#include "core/rail/structures/structure_track.h"
#include "core/rail/structures/structures.h"
#include "core/rail/track/cross_section.h"
#include "core/scene/shapes.h"

namespace railcast {
namespace {

/// The slab's top lies below the sleepers' rail seats (0.182 m below top of rail) and above their
/// middle (0.221 m).
constexpr double kSlabTop_m = -0.205;
constexpr double kSlabThickness_m = 0.24;
constexpr double kBaseWider_m = 0.3;  ///< The bound layer below, on each side.

/// The lid lies a little above the formation, 0.7 m below top of rail.
constexpr double kLidTop_m = -0.6;
constexpr double kLidThickness_m = 0.06;
constexpr double kLidOverhang_m = 0.015;
constexpr double kTroughFoot_m = -1.0;

/// The conductor rail's section: a flat-bottomed rail of 53 kg/m, simplified.
constexpr double kConductorHeight_m = 0.1;
constexpr double kConductorHead_m = 0.065;
constexpr double kConductorFoot_m = 0.11;
constexpr double kConductorWeb_m = 0.016;
/// Top contact: GLRT1212, 16 inches outside the running edge and 3 inches above the rail. Bottom
/// contact: working values after Berlin's S-Bahn.
constexpr double kTopContactDistance_m = 1.124;
constexpr double kTopContactHeight_m = 0.076;
constexpr double kBottomContactDistance_m = 1.57;
constexpr double kBottomContactHeight_m = 0.16;
constexpr double kInsulatorSpacing_m = 3.0;
constexpr double kInsulatorWidth_m = 0.1;
/// Foot of insulators, below top of rail: on the sleepers' ends.
constexpr double kInsulatorFoot_m = 0.22;
constexpr double kShieldThickness_m = 0.02;
constexpr double kShieldGap_m = 0.06;  ///< Between shield and conductor rail.
constexpr double kBoardRise_m = 0.06;  ///< Height of boards above a rail with top contact.

/// The conductor rail with its foot at z = 0, y across.
Outline ConductorOutline() {
  const double head_m = 0.5 * kConductorHead_m;
  const double foot_m = 0.5 * kConductorFoot_m;
  const double web_m = 0.5 * kConductorWeb_m;
  const double neck_m = kConductorHeight_m - 0.035;
  return {{-foot_m, 0.0},
          {foot_m, 0.0},
          {foot_m, 0.012},
          {web_m, 0.025},
          {web_m, neck_m},
          {head_m, neck_m + 0.01},
          {head_m, kConductorHeight_m},
          {-head_m, kConductorHeight_m},
          {-head_m, neck_m + 0.01},
          {-web_m, neck_m},
          {-web_m, 0.025},
          {-foot_m, 0.012}};
}

/// Sizes of a conductor rail.
struct ConductorPlace {
  bool is_top{};
  double distance_m{};
  double base_m{};  ///< Lowest edge of the conductor rail above top of rail.
};

ConductorPlace ConductorPlaceOf(const ThirdRailSpec& rail, double shift_m) {
  const bool is_top = rail.contact == ContactSide::kTop;
  const double height_m =
      rail.height_m.value_or(is_top ? kTopContactHeight_m : kBottomContactHeight_m);
  return {.is_top = is_top,
          .distance_m = rail.distance_m.value_or(
              shift_m + (is_top ? kTopContactDistance_m : kBottomContactDistance_m)),
          .base_m = is_top ? height_m - kConductorHeight_m : height_m};
}

/// Boards to either side of a rail with top contact; else a cover over the rail and its outer side.
std::vector<Outline> ShieldOutlines(const ConductorPlace& place) {
  const double near_m = 0.5 * kConductorFoot_m + kShieldGap_m;
  const double far_m = near_m + kShieldThickness_m;
  const double top_m = place.base_m + kConductorHeight_m + kBoardRise_m;
  if (place.is_top) {
    return {RectangleOutline(-far_m, place.base_m, -near_m, top_m),
            RectangleOutline(near_m, place.base_m, far_m, top_m)};
  }
  return {{{-near_m, top_m},
           {-near_m, top_m + kShieldThickness_m},
           {far_m, top_m + kShieldThickness_m},
           {far_m, place.base_m},
           {near_m, place.base_m},
           {near_m, top_m}}};
}

Outline Moved(Outline outline_m, double y_m, double z_m) {
  for (Eigen::Vector2d& point : outline_m) point += Eigen::Vector2d(y_m, z_m);
  return outline_m;
}

}  // namespace

void AddStructure(const ChunkContext& context, const SlabTrackSpec& slab, Chunk& chunk) {
  const StructureTrack track(context, slab.track);
  const double half_m = 0.5 * slab.width_m;
  const auto stretch =
      StretchInChunk(track, RangeOf(slab), half_m, [&](double s_m) { return track.Canted(s_m); });
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

void AddStructure(const ChunkContext& context, const CableTroughSpec& trough, Chunk& chunk) {
  const StructureTrack track(context, trough.track);
  const double side = SignOf(trough.side);
  const double near_m = trough.distance_m;
  const double far_m = near_m + trough.width_m;
  const auto stretch = StretchInChunk(track, RangeOf(trough), side * far_m,
                                      [&](double s_m) { return track.Upright(s_m); });
  if (!stretch) return;
  const double lid_foot_m = kLidTop_m - kLidThickness_m;
  const Outline outline_m{{near_m + kLidOverhang_m, kTroughFoot_m},
                          {far_m - kLidOverhang_m, kTroughFoot_m},
                          {far_m - kLidOverhang_m, lid_foot_m},
                          {far_m, lid_foot_m},
                          {far_m, kLidTop_m},
                          {near_m, kLidTop_m},
                          {near_m, lid_foot_m},
                          {near_m + kLidOverhang_m, lid_foot_m}};
  AppendSweptSolid(*stretch, OnSide(outline_m, side),
                   MeshOf(context.surfaces.structures.cable_trough, chunk.ground));
}

std::vector<ClearedArea> ClearedBy(const CableTroughSpec& trough) {
  return ClearedBeside(trough, trough.distance_m, trough.distance_m + trough.width_m);
}

void AddStructure(const ChunkContext& context, const ThirdRailSpec& rail, Chunk& chunk) {
  const StructureTrack track(context, rail.track);
  const StructureSurfaces& surfaces = context.surfaces.structures;
  const ConductorPlace place = ConductorPlaceOf(rail, RailShift_m(context.spec.alignment));
  const double side = SignOf(rail.side);
  const ChainageRange range = RangeOf(rail);
  const auto frame_at = [&](double s_m) -> Transform {
    return track.Canted(s_m) * Eigen::Translation3d(0.0, side * place.distance_m, 0.0);
  };
  const auto stretch = StretchInChunk(track, range, side * place.distance_m, frame_at);
  if (!stretch) return;
  AppendSweptSolid(*stretch, Moved(ConductorOutline(), 0.0, place.base_m),
                   MeshOf(surfaces.third_rail, chunk.ground));
  const double half_m = 0.5 * kInsulatorWidth_m;
  const Mesh insulator = MakeBox(
      {Vector3(-half_m, -half_m, -kInsulatorFoot_m), Vector3(half_m, half_m, place.base_m)});
  Mesh& shield = MeshOf(surfaces.third_rail_shield, chunk.ground);
  for (const double s_m : track.Places(range, kInsulatorSpacing_m)) {
    shield.Append(insulator, frame_at(s_m));
  }
  if (!rail.has_shield) return;
  for (const Outline& outline_m : ShieldOutlines(place)) {
    AppendSweptSolid(*stretch, OnSide(outline_m, side), shield);
  }
}

std::vector<ClearedArea> ClearedBy(const ThirdRailSpec&) {
  return {};
}

}  // namespace railcast
