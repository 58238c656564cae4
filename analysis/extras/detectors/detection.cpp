#include "analysis/extras/detectors/detection.h"

#include <algorithm>
#include <map>

namespace railcast {

std::vector<GaugePart> PartsOf(const std::optional<TrainGauge>& gauge) {
  if (!gauge) return {};
  return {{.half_width_m = 0.5 * gauge->width_m, .bottom_m = 0.0, .top_m = gauge->height_m}};
}

PlaceByTrack PlaceOnTrack(const OwnTrack& track, const Vector3& world_m) {
  const double s_m = track.ChainageNear_m(world_m);
  const Vector3 local_m = track.WorldFromTrack(s_m).inverse() * world_m;
  return {.chainage_m = s_m, .lateral_m = local_m.y(), .height_m = local_m.z()};
}

GaugeAhead::GaugeAhead(const OwnTrack& track,
                       const Transform& world_from_vehicle,
                       const Vector3& sensor_world_m,
                       double reach_m)
    : track_(track), sensor_s_m_(track.ChainageNear_m(sensor_world_m)), reach_m_(reach_m) {
  is_along_ =
      track.WorldFromTrack(sensor_s_m_).linear().col(0).dot(world_from_vehicle.linear().col(0)) >
      0.0;
}

std::optional<PlaceByTrack> GaugeAhead::PlaceInside(const Vector3& world_m) const {
  const std::optional<PlaceByTrack> place = track_.PlaceOf(world_m, sensor_s_m_);
  if (!place || !track_.IsInGauge(*place)) return std::nullopt;
  const double ahead_m =
      is_along_ ? place->chainage_m - sensor_s_m_ : sensor_s_m_ - place->chainage_m;
  if (ahead_m <= 0.0 || ahead_m > reach_m_) return std::nullopt;
  return place;
}

double OverlapOf(const OrientedBox& one, const OrientedBox& other) {
  constexpr int kSteps = 16;
  const bool is_one_smaller = one.size_m.prod() <= other.size_m.prod();
  const OrientedBox& smaller = is_one_smaller ? one : other;
  const OrientedBox& larger = is_one_smaller ? other : one;
  const Transform larger_from_smaller = larger.world_from_box.inverse() * smaller.world_from_box;
  const double reach_m = 0.5 * (smaller.size_m.norm() + larger.size_m.norm());
  if (larger_from_smaller.translation().norm() >= reach_m) return 0.0;
  const Vector3 half_m = 0.5 * larger.size_m;
  int num = 0;
  for (int i = 0; i < kSteps * kSteps * kSteps; ++i) {
    const Eigen::Vector3i cell(i % kSteps, i / kSteps % kSteps, i / kSteps / kSteps);
    const Vector3 middle_m =
        ((cell.array().cast<double>() + 0.5) / kSteps - 0.5) * smaller.size_m.array();
    const Vector3 local_m = larger_from_smaller * middle_m;
    num += (local_m.cwiseAbs().array() <= half_m.array()).all() ? 1 : 0;
  }
  return static_cast<double>(num) / (kSteps * kSteps * kSteps);
}

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
