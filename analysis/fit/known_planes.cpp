#include "analysis/fit/known_planes.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "analysis/estimate/robust.h"
#include "analysis/report/joined.h"
#include "core/base/error.h"
#include "core/base/number_text.h"
#include "core/base/units.h"

namespace railcast {
namespace {

bool IsWithin(const KnownPlane& plane, const Vector3& point_m) {
  if (plane.radius_m) return (point_m - plane.point_m).norm() <= *plane.radius_m;
  // Convex: on the same side of every edge.
  double first_side = 0.0;
  for (std::size_t i = 0; i < plane.corners_m.size(); ++i) {
    const Vector3& from = plane.corners_m[i];
    const Vector3& to = plane.corners_m[(i + 1) % plane.corners_m.size()];
    const double side = (to - from).cross(point_m - from).dot(plane.normal);
    if (i == 0) first_side = side;
    if (side * first_side < 0.0) return false;
  }
  return true;
}

void Refine(const std::vector<Vector3>& points_m, KnownPlane& plane) {
  constexpr int kRounds = 20;
  constexpr double kTukey = 4.685;
  constexpr double kLeastScale_m = 1e-3;
  std::vector<double> weights(points_m.size(), 1.0);
  Vector3 center = plane.point_m;
  Vector3 normal = plane.normal;
  for (int round = 0; round < kRounds; ++round) {
    Vector3 sum = Vector3::Zero();
    double mass = 0.0;
    for (std::size_t i = 0; i < points_m.size(); ++i) {
      sum += weights[i] * points_m[i];
      mass += weights[i];
    }
    center = sum / mass;
    Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
    for (std::size_t i = 0; i < points_m.size(); ++i) {
      const Vector3 arm = points_m[i] - center;
      scatter += weights[i] * arm * arm.transpose();
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(scatter);
    normal = solver.eigenvectors().col(0);
    if (normal.dot(plane.normal) < 0.0) normal = -normal;
    std::vector<double> distances_m;
    for (const Vector3& point_m : points_m) distances_m.push_back(normal.dot(point_m - center));
    // About the median: the center may still lie between the plane and what stands before it.
    std::vector<double> sorted_m = distances_m;
    const double median_m = Median(sorted_m).value;
    const double scale_m = std::max(kLeastScale_m, RobustScale(sorted_m).value);
    for (std::size_t i = 0; i < points_m.size(); ++i) {
      const double pull = (distances_m[i] - median_m) / (kTukey * scale_m);
      weights[i] = std::abs(pull) < 1.0 ? std::pow(1.0 - pull * pull, 2) : 0.0;
    }
  }
  const auto onto = [&](const Vector3& point_m) {
    return Vector3(point_m - normal.dot(point_m - center) * normal);
  };
  plane.point_m = onto(plane.point_m);
  for (Vector3& corner_m : plane.corners_m) corner_m = onto(corner_m);
  plane.normal = normal;
}

}  // namespace

std::optional<PlaneHit> HitPlanes(const std::vector<KnownPlane>& planes, const Vector3& direction) {
  std::optional<PlaneHit> nearest;
  for (std::size_t i = 0; i < planes.size(); ++i) {
    const double along = planes[i].normal.dot(direction);
    const double range_m = planes[i].normal.dot(planes[i].point_m) / along;
    if (!(range_m > 0.0 && std::isfinite(range_m))) continue;
    if (nearest && nearest->range_m <= range_m) continue;
    if (IsWithin(planes[i], range_m * direction)) nearest = {i, range_m, std::abs(along)};
  }
  return nearest;
}

std::vector<std::size_t> RefinePlanes(const std::vector<Vector3>& points_m,
                                      std::vector<KnownPlane>& planes) {
  constexpr double kReach_m = 0.3;
  constexpr double kMaxTurn_deg = 10.0;
  std::vector<std::size_t> counts;
  ErrorList errors;
  for (KnownPlane& plane : planes) {
    std::vector<Vector3> near_m;
    for (const Vector3& point_m : points_m) {
      const double distance_m = plane.normal.dot(point_m - plane.point_m);
      if (std::abs(distance_m) > kReach_m) continue;
      if (IsWithin(plane, point_m - distance_m * plane.normal)) near_m.push_back(point_m);
    }
    counts.push_back(near_m.size());
    const std::string name = Joined({"plane \"", plane.name, "\": "});
    if (near_m.size() < kMinPlanePoints) {
      const std::string rule =
          "must have at least 50 points within 0.3 m in the first frames (got ";
      errors.Add(Joined({name, rule, NumberText(near_m.size()), ")"}));
      continue;
    }
    const Vector3 given = plane.normal;
    Refine(near_m, plane);
    const double turn_deg = DegFromRad(std::acos(std::min(1.0, given.dot(plane.normal))));
    if (turn_deg > kMaxTurn_deg) {
      const std::string rule = "the points within 0.3 m must lie on it, not on one turned by more ";
      errors.Add(
          Joined({name, rule, "than 10 deg (got ", NumberText(std::round(turn_deg)), " deg)"}));
    }
  }
  errors.ThrowIfAny();
  return counts;
}

}  // namespace railcast
