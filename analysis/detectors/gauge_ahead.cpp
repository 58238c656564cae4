#include "analysis/detectors/gauge_ahead.h"

#include <algorithm>
#include <cmath>

namespace railcast {
namespace {

/// Within half of it a track leaves its tangent by at most 2.5^2 / (2 R): 3 cm at R = 100 m.
constexpr double kStationStep_m = 5.0;
/// Points that are farther from the gauge by a station's tangent are not in it.
constexpr double kTangentError_m = 0.5;

}  // namespace

std::vector<GaugePart> PartsOf(const std::optional<TrainGauge>& gauge) {
  if (!gauge) return {};
  return {{.half_width_m = 0.5 * gauge->width_m, .bottom_m = 0.0, .top_m = gauge->height_m}};
}

PlaceByTrack PlaceOnTrack(const OwnTrack& track, double near_s_m, const Vector3& world_m) {
  const double s_m = track.Refined_m(near_s_m, world_m);
  const Vector3 local_m = track.WorldFromTrack(s_m).inverse() * world_m;
  return {s_m, local_m.y(), local_m.z()};
}

GaugeAhead::GaugeAhead(const OwnTrack& track,
                       const Transform& world_from_vehicle,
                       const Vector3& sensor_world_m,
                       double reach_m)
    : track_(track), sensor_s_m_(track.ChainageNear_m(sensor_world_m)) {
  is_along_ =
      track.WorldFromTrack(sensor_s_m_).linear().col(0).dot(world_from_vehicle.linear().col(0)) >
      0.0;
  for (const GaugePart& part : track.gauge()) {
    most_half_width_m_ = std::max(most_half_width_m_, part.half_width_m);
    top_m_ = std::max(top_m_, part.top_m);
  }
  for (double ahead_m = 0.0; ahead_m < reach_m + kStationStep_m; ahead_m += kStationStep_m) {
    const double s_m = sensor_s_m_ + (is_along_ ? ahead_m : -ahead_m);
    if (s_m < track.begin_s_m() || s_m > track.end_s_m()) break;
    const Transform world_from_track = track.WorldFromTrack(s_m);
    stations_.push_back({s_m, world_from_track.inverse()});
    axis_m_.emplace_back(world_from_track.translation());
  }
}

std::optional<PlaceByTrack> GaugeAhead::PlaceInside(const Vector3& world_m) const {
  const auto nearest = std::ranges::min_element(
      axis_m_, {}, [&](const Vector3& axis_m) { return (axis_m - world_m).squaredNorm(); });
  if (nearest == axis_m_.end()) return std::nullopt;
  const Station& station = stations_[static_cast<std::size_t>(nearest - axis_m_.begin())];
  const Vector3 roughly_m = station.track_from_world * world_m;
  if (std::abs(roughly_m.x()) > kStationStep_m ||
      std::abs(roughly_m.y()) > most_half_width_m_ + kTangentError_m ||
      roughly_m.z() < -kTangentError_m || roughly_m.z() > top_m_ + kTangentError_m) {
    return std::nullopt;
  }
  const PlaceByTrack place = PlaceOnTrack(track_, station.s_m, world_m);
  const double s_m = place.x();
  const bool is_ahead = is_along_ ? s_m > sensor_s_m_ : s_m < sensor_s_m_;
  if (!is_ahead || s_m < track_.begin_s_m() || s_m > track_.end_s_m()) return std::nullopt;
  const bool is_inside = std::ranges::any_of(track_.gauge(), [&](const GaugePart& part) {
    return std::abs(place.y()) < part.half_width_m && place.z() > part.bottom_m &&
           place.z() < part.top_m;
  });
  if (!is_inside) return std::nullopt;
  return place;
}

}  // namespace railcast
