#include "core/rail/structures/floors.h"

#include <algorithm>
#include <limits>
#include <variant>

#include "core/rail/structures/structure_track.h"

namespace railcast {

Floors::Floors(const ChunkContext& context, const ChainageRange& range)
    : context_(&context), roads_(RoadsNear(context, range)) {
  for (const StructureSpec& structure : context.spec.structures) {
    const auto* platform = std::get_if<PlatformSpec>(&structure);
    if (platform == nullptr) continue;
    if (platform->end_s_m < range.begin_s_m || platform->begin_s_m > range.end_s_m) continue;
    platforms_.push_back(platform);
  }
}

double Floors::HeightAt_m(double s_m, double d_m) const {
  double height_m = -std::numeric_limits<double>::infinity();
  for (const CrossingRoad& road : roads_) {
    if (road.Covers(s_m, d_m)) height_m = std::max(height_m, road.PointAt(s_m, d_m).z());
  }
  for (const PlatformSpec* platform : platforms_) {
    if (s_m < platform->begin_s_m || s_m > platform->end_s_m) continue;
    const StructureTrack track(*context_, platform->track);
    const double side = SignOf(platform->side);
    const double behind_edge_m = side * (d_m - track.offset_m(s_m)) - platform->edge_distance_m;
    if (behind_edge_m < 0.0 || behind_edge_m > platform->width_m) continue;
    const Transform edge =
        track.UprightAt(s_m, side * platform->edge_distance_m, platform->height_m);
    height_m = std::max(height_m, edge.translation().z());
  }
  return height_m;
}

}  // namespace railcast
