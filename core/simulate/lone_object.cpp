#include "core/simulate/lone_object.h"

#include <algorithm>
#include <bit>

#include "railcast/lidar.h"

namespace railcast {

void LoneObjects::CountHits(const RayTile& rays,
                            std::size_t num_firings,
                            std::vector<std::atomic<std::uint32_t>>& counts) const {
  std::vector<PlacementHits> hits;
  for (std::size_t first = 0; first < num_firings; first += kPacketSize) {
    const std::size_t num_lanes = std::min(kPacketSize, num_firings - first);
    const std::uint32_t firings = (1U << num_lanes) - 1U;
    scene->CastThrough(rays, first, hits);
    std::erase_if(hits, [&](const PlacementHits& hit) { return hit.placement >= objects.size(); });
    const auto object_of = [&](const PlacementHits& hit) { return objects[hit.placement]; };
    std::ranges::sort(hits, {}, object_of);
    for (auto hit = hits.begin(); hit != hits.end();) {
      const std::size_t object = object_of(*hit);
      // A ray that goes through several pieces of an object counts once.
      std::uint32_t lanes = 0;
      for (; hit != hits.end() && object_of(*hit) == object; ++hit) lanes |= hit->lanes;
      counts[object] += static_cast<std::uint32_t>(std::popcount(lanes & firings));
    }
  }
}

}  // namespace railcast
