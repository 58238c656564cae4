#include "analysis/compare/cloud.h"

#include <cmath>

namespace railcast {

ComparedCloud CloudOf(const RecordedFrame& recorded) {
  const Frame& frame = recorded.frame;
  ComparedCloud cloud;
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    const float x = frame.x[slot], y = frame.y[slot], z = frame.z[slot];
    if (!std::isfinite(x) || !std::isfinite(y) || !std::isfinite(z)) continue;
    cloud.points->push_back({x, y, z});
    cloud.range_m.push_back(std::hypot(x, y, z));
    if (recorded.Has("intensity")) cloud.intensity.push_back(frame.intensity[slot]);
    if (recorded.Has("ring")) cloud.rings.push_back(frame.ring[slot]);
  }
  return cloud;
}

}  // namespace railcast
