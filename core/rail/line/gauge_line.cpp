#include "core/rail/line/gauge_line.h"

#include <cmath>
#include <utility>

#include "core/rail/base/rail_section.h"

namespace railcast {
namespace {

constexpr double kHalfGauge_m = 0.5 * kGauge_m;

}  // namespace

GaugeLine::GaugeLine(TrackCourse course, bool is_left)
    : course_(std::move(course)), side_(is_left ? 1.0 : -1.0) {}

PlanePlace GaugeLine::At(double s_m) const {
  const TrackOffset offset = course_.OffsetAt(s_m);
  const double heading_rad = std::atan(offset.slope);
  return {s_m - side_ * kHalfGauge_m * std::sin(heading_rad),
          offset.d_m + side_ * kHalfGauge_m * std::cos(heading_rad)};
}

double GaugeLine::FrameAt_m(double plane_s_m) const {
  constexpr int kNumSteps = 8;  // Each makes the error smaller by the track's change of slope.
  double s_m = plane_s_m;
  for (int i = 0; i < kNumSteps; ++i) {
    const double next_s_m = s_m + (plane_s_m - At(s_m).s_m);
    if (next_s_m == s_m) break;  // All others would be the same, too.
    s_m = next_s_m;
  }
  return s_m;
}

double GaugeLine::LateralAt_m(double plane_s_m) const {
  return At(FrameAt_m(plane_s_m)).d_m;
}

}  // namespace railcast
