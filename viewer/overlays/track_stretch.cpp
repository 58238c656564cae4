#include "viewer/overlays/track_stretch.h"

#include <algorithm>
#include <cmath>

namespace railcast {

Transform TrackStretch::SensorFromTrack(double s_m) const {
  return sensor_from_world * track.WorldFromTrack(alignment, s_m);
}

std::vector<double> TrackStretch::LineChainages_m() const {
  std::vector<double> chainages_m = WholeChainages_m(1.0);
  if (chainages_m.empty() || chainages_m.front() > from_s_m) {
    chainages_m.insert(chainages_m.begin(), from_s_m);
  }
  if (chainages_m.back() < to_s_m) chainages_m.push_back(to_s_m);
  return chainages_m;
}

std::vector<double> TrackStretch::WholeChainages_m(double step_m) const {
  std::vector<double> chainages_m;
  for (double step = std::ceil(from_s_m / step_m); step * step_m <= to_s_m; step += 1.0) {
    chainages_m.push_back(step * step_m);
  }
  return chainages_m;
}

std::optional<TrackStretch> StretchAbout(const RailWorld& world,
                                         const RecordedFrame& recorded,
                                         double behind_m,
                                         double ahead_m) {
  if (!recorded.has_pose) return std::nullopt;
  const std::int64_t stamp_ns = recorded.frame.stamp_ns;
  const TrackCourse& track = world.vehicle_course();
  const Alignment& alignment = world.alignment();
  const double vehicle_s_m = world.VehicleChainage_m(stamp_ns);
  const bool is_along = world.WorldFromVehicle(stamp_ns).linear().col(0).dot(
                            track.WorldFromTrack(alignment, vehicle_s_m).linear().col(0)) > 0.0;
  TrackStretch stretch{.alignment = alignment,
                       .track = track,
                       .from_s_m = vehicle_s_m - (is_along ? behind_m : ahead_m),
                       .to_s_m = vehicle_s_m + (is_along ? ahead_m : behind_m),
                       .sensor_from_world = recorded.frame.world_from_sensor.inverse()};
  stretch.from_s_m = std::max(stretch.from_s_m, track.begin_s_m());
  stretch.to_s_m = std::min(stretch.to_s_m, track.end_s_m());
  if (!(stretch.from_s_m < stretch.to_s_m)) return std::nullopt;
  return stretch;
}

}  // namespace railcast
