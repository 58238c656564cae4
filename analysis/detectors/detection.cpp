#include "analysis/detectors/detection.h"

#include <algorithm>
#include <map>
#include <utility>

namespace railcast {

OrientedBox BoxOfCluster(const OwnTrack& track, const std::vector<PlaceByTrack>& places) {
  constexpr double kLeastSide_m = 0.1;
  Eigen::AlignedBox3d bounds_m;
  for (const PlaceByTrack& place : places) {
    bounds_m.extend(Vector3(place.chainage_m, place.lateral_m, place.height_m));
  }
  const Vector3 middle_m = bounds_m.center();
  OrientedBox box;
  box.world_from_box = track.WorldFromTrack(middle_m.x());
  box.world_from_box.translate(Vector3(0.0, middle_m.y(), middle_m.z()));
  box.size_m = bounds_m.sizes().cwiseMax(kLeastSide_m);
  return box;
}

std::uint32_t MostFrequentLabel(const std::vector<std::uint32_t>& labels) {
  std::map<std::uint32_t, std::size_t> counts;
  for (const std::uint32_t label : labels) ++counts[label];
  const auto most =
      std::ranges::max_element(counts, {}, [](const auto& count) { return count.second; });
  return most == counts.end() ? 0 : most->first;
}

}  // namespace railcast
