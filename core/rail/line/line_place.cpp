#include "core/rail/line/line_place.h"

#include <algorithm>
#include <cmath>

namespace railcast {

PlaceBesideLine PlaceOnLine(const Alignment& alignment,
                            const Vector3& place_world_m,
                            double near_s_m) {
  constexpr int kNumSteps = 12;
  constexpr double kExact_m = 1e-6;
  PlaceBesideLine place{.s_m = near_s_m};
  for (int i = 0; i < kNumSteps; ++i) {
    const AxisPoint axis = alignment.At(place.s_m);
    const Eigen::Vector2d ahead(std::cos(axis.heading_rad), std::sin(axis.heading_rad));
    const Vector3 from_axis_m = place_world_m - axis.position_m;
    place.d_m = ahead.x() * from_axis_m.y() - ahead.y() * from_axis_m.x();
    place.h_m = from_axis_m.z();
    // Beyond the centre of a curve, steps must not change their direction.
    const double step_m =
        ahead.dot(from_axis_m.head<2>()) / std::max(0.2, 1.0 - axis.curvature_per_m * place.d_m);
    place.s_m += step_m;
    if (std::abs(step_m) < kExact_m) break;
  }
  return place;
}

}  // namespace railcast
