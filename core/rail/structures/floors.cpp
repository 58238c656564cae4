#include "core/rail/structures/floors.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <variant>

#include "core/rail/structures/structure_types.h"

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
    if (!road.Covers(s_m, d_m)) continue;
    const Vector3 world_m = context_->chunk_from_world.inverse() * road.PointAt(s_m, d_m);
    height_m = std::max(height_m, world_m.z());
  }
  for (const PlatformSpec* platform : platforms_) {
    const std::optional<double> top_m = PlatformTop_m(*context_, *platform, s_m, d_m);
    if (top_m) height_m = std::max(height_m, *top_m);
  }
  return height_m;
}

}  // namespace railcast
