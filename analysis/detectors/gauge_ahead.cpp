#include "analysis/detectors/gauge_ahead.h"

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

}  // namespace railcast
