#include <cmath>
#include <string>
#include <vector>

#include "core/base/text.h"
#include "core/track/found_track.h"
#include "viewer/color/palette.h"
#include "viewer/overlays/overlays.h"

namespace railcast {

Overlay DrawFoundTracks(const std::vector<FoundTrack>& tracks) {
  constexpr double kStep_m = 1.0;
  constexpr double kTickStep_m = 5.0;
  Overlay drawing;
  for (const FoundTrack& track : tracks) {
    const Transform sensor_from_track = track.track_from_sensor.inverse();
    const double curvature_per_m = track.curvature_per_m.value;
    const double half_m = 0.5 * (track.gauge_m.value + kHeadWidth_m);
    const auto place = [&](double x_m, double left_m) {
      // Across the curve, which turns by its curvature with each metre.
      const double turn_rad = curvature_per_m * x_m;
      return Vector3(sensor_from_track *
                     Vector3(x_m - left_m * std::sin(turn_rad),
                             ArcRise_m(curvature_per_m, x_m) + left_m * std::cos(turn_rad), 0.0));
    };
    for (const double left_m : {half_m, -half_m}) {
      std::vector<Vector3> head_m;
      for (double x_m = track.first_m; x_m < track.last_m + kStep_m; x_m += kStep_m)
        head_m.push_back(place(std::min(x_m, track.last_m), left_m));
      AddPolyline(head_m, kYellow, drawing);
    }
    if (&track != &tracks.front()) continue;
    for (const double x_m : WholeChainages_m(track.first_m, track.last_m, kTickStep_m)) {
      AddSegment(place(x_m, half_m), place(x_m, -half_m), kYellow, drawing);
      AddWord(place(x_m, half_m), NumberText(x_m) + " m", kYellow, drawing);
    }
  }
  return drawing;
}

}  // namespace railcast
