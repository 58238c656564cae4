#include "generator/import/network/track_sketch.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace railcast {
namespace {

constexpr std::array<TurnoutShape, 4> kShapes = {{{"1:9-190", 9.0, 190.0, 27.138, 40.0},
                                                  {"1:9-300", 9.0, 300.0, 33.230, 50.0},
                                                  {"1:12-500", 12.0, 500.0, 41.594, 60.0},
                                                  {"1:14-760", 14.0, 760.0, 54.216, 80.0}}};

}  // namespace

double TrackSketch::OffsetAt_m(double s_m) const {
  const double along_m = std::max(0.0, s_m - begin_s_m);
  const auto before = std::min(static_cast<std::size_t>(along_m), offsets_m.size() - 2);
  return std::lerp(offsets_m[before], offsets_m[before + 1], along_m - static_cast<double>(before));
}

bool TrackSketch::IsStraight(double one_s_m, double other_s_m) const {
  const auto [from_m, to_m] = std::minmax(one_s_m, other_s_m);
  return std::ranges::any_of(straights_m, [&](const auto& straight) {
    return straight.first <= from_m && straight.second >= to_m;
  });
}

double TurnoutShape::angle_rad() const {
  return std::atan(1.0 / ratio);
}

double TurnoutShape::tangent_m() const {
  return radius_m * std::tan(0.5 * angle_rad());
}

double TurnoutShape::least_distance_m() const {
  const double straight_m = length_m - 2.0 * tangent_m();
  return 2.0 * radius_m * (1.0 - std::cos(angle_rad())) + straight_m * std::sin(angle_rad());
}

double TurnoutShape::Parallel_m(double distance_m) const {
  const double arcs_m = 2.0 * radius_m * (1.0 - std::cos(angle_rad()));
  return 2.0 * radius_m * std::sin(angle_rad()) + (distance_m - arcs_m) * ratio;
}

double TurnoutShape::OffsetAt_m(double x_m, double distance_m) const {
  const double arc_x_m = radius_m * std::sin(angle_rad());
  const auto arc_m = [&](double along_m) {
    return radius_m - std::sqrt(radius_m * radius_m - along_m * along_m);
  };
  const double end_x_m = Parallel_m(distance_m);
  if (x_m <= 0.0) return 0.0;
  if (x_m <= arc_x_m) return arc_m(x_m);
  if (x_m >= end_x_m) return distance_m;
  if (x_m >= end_x_m - arc_x_m) return distance_m - arc_m(end_x_m - x_m);
  return arc_m(arc_x_m) + (x_m - arc_x_m) / ratio;
}

const TurnoutShape& ShapeFor(double speed_kmph) {
  const auto fast = std::ranges::find_if(
      kShapes, [&](const TurnoutShape& shape) { return shape.speed_kmph >= speed_kmph; });
  return fast == kShapes.end() ? kShapes.back() : *fast;
}

}  // namespace railcast
