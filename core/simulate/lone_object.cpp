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
    for (const PlacementHits& hit : hits) {
      if (hit.placement >= objects.size()) continue;
      counts[objects[hit.placement]] +=
          static_cast<std::uint32_t>(std::popcount(hit.lanes & firings));
    }
  }
}

}  // namespace railcast
