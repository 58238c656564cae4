#include "core/rail/clearance/cleared.h"

#include <algorithm>
#include <cmath>

namespace railcast {
namespace {

constexpr double kTreeMargin_m = 2.0;
/// Half of a patch of grass, and of its diagonal's excess.
constexpr double kGrassMargin_m = 1.2;
constexpr double kMastMargin_m = 0.2;

ClearedArea WithMargin(const ClearedArea& area, double margin_m, Clearing what) {
  return {.begin_s_m = area.begin_s_m - margin_m,
          .end_s_m = area.end_s_m + margin_m,
          .right_m = area.right_m - margin_m,
          .left_m = area.left_m + margin_m,
          .cleared = {what}};
}

/// Whether a bridge or tunnel surely clears nothing of this kind between two chainages. Their areas
/// depend on all tracks beside them, and are asked for at each cross-section.
bool IsElsewhere(const StructureSpec& structure, Clearing what, double begin_s_m, double end_s_m) {
  if (!std::holds_alternative<BridgeSpec>(structure) &&
      !std::holds_alternative<TunnelSpec>(structure)) {
    return false;
  }
  if (what == Clearing::kBallast || what == Clearing::kMast) return true;
  const StretchSpec& stretch = *StretchOf(structure);
  return stretch.end_s_m + kTreeMargin_m < begin_s_m || stretch.begin_s_m - kTreeMargin_m > end_s_m;
}

}  // namespace

std::vector<ClearedArea> ClearedAreasOf(const WorldTracks& tracks, const StructureSpec& structure) {
  return std::visit(
      [&](const auto& spec) {
        if constexpr (requires { ClearedBy(tracks, spec); }) {
          return ClearedBy(tracks, spec);
        } else {
          return ClearedBy(spec);
        }
      },
      structure);
}

std::vector<ClearedArea> ClearedAround(const ClearedArea& outline) {
  return {WithMargin(outline, kTreeMargin_m, Clearing::kTree),
          WithMargin(outline, kGrassMargin_m, Clearing::kGrass),
          WithMargin(outline, kMastMargin_m, Clearing::kMast)};
}

std::vector<ClearedArea> ClearedBeside(const SideStretchSpec& structure,
                                       double near_m,
                                       double far_m) {
  const double side = SignOf(structure.side);
  return ClearedAround({.begin_s_m = structure.begin_s_m,
                        .end_s_m = structure.end_s_m,
                        .right_m = std::min(side * near_m, side * far_m),
                        .left_m = std::max(side * near_m, side * far_m),
                        .cleared = {}});
}

ClearedAreas::ClearedAreas(const WorldTracks& tracks,
                           Clearing what,
                           double begin_s_m,
                           double end_s_m)
    : begin_s_m_(begin_s_m), end_s_m_(end_s_m) {
  for (const StructureSpec& structure : tracks.world.structures) {
    const TrackCourse* track =
        tracks.CourseOf(std::visit([](const auto& spec) { return spec.track; }, structure));
    if (track == nullptr || IsElsewhere(structure, what, begin_s_m, end_s_m)) continue;
    for (ClearedArea& area : ClearedAreasOf(tracks, structure)) {
      if (area.end_s_m < begin_s_m || area.begin_s_m > end_s_m) continue;
      if (std::ranges::find(area.cleared, what) == area.cleared.end()) continue;
      areas_.push_back({track, std::move(area)});
    }
  }
}

bool ClearedAreas::Cover(double s_m, double d_m) const {
  return std::ranges::any_of(areas_, [&](const TrackArea& cleared) {
    if (s_m < cleared.area.begin_s_m || s_m > cleared.area.end_s_m) return false;
    const double from_track_m = d_m - cleared.track->OffsetAt(s_m).d_m;
    return from_track_m >= cleared.area.right_m && from_track_m <= cleared.area.left_m;
  });
}

bool IsCleared(const WorldTracks& tracks, double s_m, double d_m, Clearing what) {
  return !tracks.world.structures.empty() && ClearedAreas(tracks, what, s_m, s_m).Cover(s_m, d_m);
}

}  // namespace railcast
