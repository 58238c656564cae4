#pragma once

#include <Eigen/Core>
#include <vector>

namespace railcast {

/// A level area that a sensor sees below it.
struct LevelArea {
  double below_m{};  ///< By how much its plane, at the sensor, is below the sensor.
  double area_m2{};  ///< What was seen of it.
};

/// Points nearer than kOwn_m in plan and less than kOwnBelow_m below the sensor are those of the
/// vehicle that carries it.
inline constexpr double kOwn_m = 3.0;
inline constexpr double kOwnBelow_m = 1.0;

/// Finds the level areas below a sensor, the largest first: planes that slope by less than 10
/// degrees through squares of 0.5 m, up to 25 m away and 2 degrees below the horizon or more, whose
/// points are within 0.2 m of each other: through 5 m2 and a fifth of these or more.
/// One area belongs to each 0.25 m of height at the sensor, so that slopes and cambers are not
/// several. What is seen of the vehicle itself does not count.
/// @param points_m From the sensor, z upward, in any order.
[[nodiscard]] std::vector<LevelArea> FindLevelAreas(const std::vector<Eigen::Vector3f>& points_m);

/// How high the sensor is above the ground: above the largest of the areas, if no other one has
/// half as much.
struct GroundBelow {
  double below_m{};
  bool is_found{};
  /// The two largest areas, where both could be the ground; else empty.
  std::vector<LevelArea> rivals;
};
[[nodiscard]] GroundBelow FindGroundBelow(const std::vector<Eigen::Vector3f>& points_m);

}  // namespace railcast
