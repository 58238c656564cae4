#include "core/rail/structures/cleared.h"

#include <algorithm>

#include "core/rail/structures/structure_track.h"
#include "core/rail/structures/structure_types.h"

namespace railcast {
namespace {

constexpr double kTreeMargin_m = 2.0;
/// Half of a patch of grass, and of its diagonal's excess.
constexpr double kGrassMargin_m = 1.2;
constexpr double kMastMargin_m = 0.5;

ClearedArea WithMargin(const ClearedArea& area, double margin_m, Clearing what) {
  return {.begin_s_m = area.begin_s_m - margin_m,
          .end_s_m = area.end_s_m + margin_m,
          .right_m = area.right_m - margin_m,
          .left_m = area.left_m + margin_m,
          .cleared = {what}};
}

bool Covers(const ClearedArea& area, const TrackSpec& track, double s_m, double d_m) {
  if (s_m < area.begin_s_m || s_m > area.end_s_m) return false;
  const double from_track_m = d_m - TrackOffsetAt_m(track, s_m);
  return from_track_m >= area.right_m && from_track_m <= area.left_m;
}

}  // namespace

std::vector<ClearedArea> ClearedAreasOf(const StructureSpec& structure) {
  return std::visit([](const auto& spec) { return ClearedBy(spec); }, structure);
}

std::vector<ClearedArea> ClearedAround(const ClearedArea& outline) {
  return {WithMargin(outline, kTreeMargin_m, Clearing::kTree),
          WithMargin(outline, kGrassMargin_m, Clearing::kGrass),
          WithMargin(outline, kMastMargin_m, Clearing::kMast)};
}

bool IsCleared(const WorldSpec& world, double s_m, double d_m, Clearing what) {
  return std::ranges::any_of(world.structures, [&](const StructureSpec& structure) {
    const TrackSpec* track = FindTrack(
        world,
        std::visit([](const auto& spec) -> const std::string& { return spec.track; }, structure));
    if (track == nullptr) return false;
    const std::vector<ClearedArea> areas = ClearedAreasOf(structure);
    return std::ranges::any_of(areas, [&](const ClearedArea& area) {
      return std::ranges::find(area.cleared, what) != area.cleared.end() &&
             Covers(area, *track, s_m, d_m);
    });
  });
}

}  // namespace railcast
