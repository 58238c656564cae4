#include "generator/check/vehicle_way.h"

#include <numeric>

#include "core/rail/motion/speed_profile.h"

namespace railcast {
namespace {

// A point that is not reached within a year counts as never reached.
constexpr double kForever_s = 365.0 * 24.0 * 3600.0;
// Needed because a stop is approached ever more slowly; at 1 m/s^2 this is 45 us before it.
constexpr double kArrival_m = 1e-9;
constexpr int kNumBisections = 80;

WayPoint PointAt(const SpeedProfile& profile, double time_s) {
  const SpeedProfile::State state = profile.At(time_s);
  return {time_s, state.s_m, state.speed_mps};
}

// Found by bisection, since the chainage is a monotonic function of time.
std::optional<WayPoint> ArrivalAt(const SpeedProfile& profile, double s_m) {
  const auto is_there = [&](double time_s) {
    const double ahead_m = s_m - profile.At(time_s).s_m;
    return (profile.reverse() ? -ahead_m : ahead_m) <= kArrival_m;
  };
  double after_s = 1.0;
  while (!is_there(after_s)) {
    after_s *= 2.0;
    if (after_s > kForever_s) return std::nullopt;
  }
  double before_s = 0.0;
  if (is_there(before_s)) return PointAt(profile, before_s);
  for (int i = 0; i < kNumBisections; ++i) {
    const double middle_s = std::midpoint(before_s, after_s);
    (is_there(middle_s) ? after_s : before_s) = middle_s;
  }
  return PointAt(profile, after_s);
}

}  // namespace

VehicleWay FindVehicleWay(const VehicleSpec& vehicle, const TrackCourse& track) {
  const SpeedProfile profile(vehicle.motion, vehicle.start_s_m);
  VehicleWay way;
  way.start = PointAt(profile, 0.0);
  if (!vehicle.motion.profile.empty()) {
    const SpeedPoint& last = vehicle.motion.profile.back();
    way.profile_end = last.time_s ? PointAt(profile, *last.time_s) : ArrivalAt(profile, *last.s_m);
    if (way.profile_end) way.profile_end->speed_mps = last.speed_mps;
  }
  way.track_end = ArrivalAt(profile, profile.reverse() ? track.begin_s_m() : track.end_s_m());
  return way;
}

}  // namespace railcast
