#include "core/simulate/lone_object.h"

#include <algorithm>

namespace railcast {

void LoneObjects::AddHits(const RayTile& rays,
                          std::size_t first,
                          std::vector<ObjectHits>& hits) const {
  std::vector<PlacementHits> pieces;
  scene->CastThrough(rays, first, pieces);
  const auto num_before = static_cast<std::ptrdiff_t>(hits.size());
  for (const PlacementHits& piece : pieces) {
    if (piece.placement >= objects.size()) continue;
    const std::size_t object = objects[piece.placement];
    // A ray that goes through several pieces of an object hits it once.
    const auto known = std::find_if(hits.begin() + num_before, hits.end(),
                                    [=](const ObjectHits& hit) { return hit.object == object; });
    if (known == hits.end()) {
      hits.push_back({object, piece.lanes});
    } else {
      known->lanes |= piece.lanes;
    }
  }
}

}  // namespace railcast
