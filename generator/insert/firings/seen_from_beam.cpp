#include "generator/insert/firings/seen_from_beam.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace railcast {

SeenPoint SeenFromBeam(const std::array<double, 2>& origin_m,
                       double channel_azimuth_rad,
                       const Frame& frame,
                       std::size_t slot) {
  const auto x = static_cast<double>(frame.x[slot]);
  const auto y = static_cast<double>(frame.y[slot]);
  const double up_m = static_cast<double>(frame.z[slot]) - origin_m[1];
  const double from_axis_m = std::hypot(x, y);
  const double along_m = origin_m[0] * std::cos(channel_azimuth_rad);
  const double aside_m = origin_m[0] * std::sin(channel_azimuth_rad);
  const double level_m =
      std::sqrt(std::max(0.0, from_axis_m * from_axis_m - aside_m * aside_m)) - along_m;
  const double rotor_rad =
      std::atan2(y, x) - std::atan2(level_m * std::sin(channel_azimuth_rad),
                                    origin_m[0] + level_m * std::cos(channel_azimuth_rad));
  return {.azimuth_rad = rotor_rad + channel_azimuth_rad,
          .rotor_rad = rotor_rad,
          .elevation_rad = std::atan2(up_m, level_m),
          .range_m = std::hypot(up_m, level_m)};
}

Frame SeenFromBeams(const std::array<double, 2>& origin_m, const Frame& frame) {
  Frame seen;
  seen.Resize(frame.rows, frame.columns, frame.returns);
  std::ranges::fill(seen.range_m, std::numeric_limits<float>::quiet_NaN());
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    if (std::isnan(frame.x[slot])) continue;
    const SeenPoint point = SeenFromBeam(origin_m, 0.0, frame, slot);
    const double level_m = point.range_m * std::cos(point.elevation_rad);
    seen.x[slot] = static_cast<float>(level_m * std::cos(point.azimuth_rad));
    seen.y[slot] = static_cast<float>(level_m * std::sin(point.azimuth_rad));
    seen.z[slot] = static_cast<float>(point.range_m * std::sin(point.elevation_rad));
    seen.range_m[slot] = static_cast<float>(point.range_m);
  }
  return seen;
}

}  // namespace railcast
