#include "core/scene/convex_body.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "core/base/error.h"

namespace railcast {
namespace {

// Bodies nearer than this meet: float32 coordinates of a wagon are no finer.
constexpr double kMeet_m = 1e-6;

/// The points a - b of two bodies A and B. Their hull contains the origin if the bodies meet.
class Difference {
 public:
  Difference(const ConvexBody& one, const Transform& one_from_other, const ConvexBody& other)
      : one_m_(one.corners_m) {
    other_m_.reserve(other.corners_m.size());
    for (const Vector3& corner : other.corners_m) other_m_.push_back(one_from_other * corner);
  }

  /// The point that lies farthest in a direction.
  [[nodiscard]] Vector3 Farthest(const Vector3& direction) const {
    return FarthestOf(one_m_, direction) - FarthestOf(other_m_, -direction);
  }
  [[nodiscard]] Vector3 AnyPoint() const { return one_m_.front() - other_m_.front(); }

 private:
  static const Vector3& FarthestOf(const std::vector<Vector3>& points, const Vector3& direction) {
    std::size_t farthest = 0;
    double farthest_m = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double distance_m = direction.dot(points[i]);
      if (distance_m > farthest_m) {
        farthest_m = distance_m;
        farthest = i;
      }
    }
    return points[farthest];
  }

  const std::vector<Vector3>& one_m_;
  std::vector<Vector3> other_m_;
};

/// One to four points.
class Simplex {
 public:
  void Add(const Vector3& corner) { corners_.at(size_++) = corner; }
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] const Vector3& operator[](std::size_t i) const { return corners_[i]; }

 private:
  std::array<Vector3, 4> corners_;
  std::size_t size_ = 0;
};

/// Returns the point nearest to the origin in the plane, line or point through all corners of a
/// simplex, and whether it lies within the simplex.
std::pair<Vector3, bool> NearestInSpan(const Simplex& corners) {
  const auto num_edges = static_cast<Eigen::Index>(corners.size()) - 1;
  if (num_edges == 0) return {corners[0], true};
  using Edges = Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 3>;
  using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 3>;
  using Shares = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1>;
  Edges edges(3, num_edges);
  for (Eigen::Index i = 0; i < num_edges; ++i) {
    edges.col(i) = corners[static_cast<std::size_t>(i) + 1] - corners[0];
  }
  const Square normal = edges.transpose() * edges;
  const Eigen::LDLT<Square> solver(normal);
  const Shares shares = solver.solve(-edges.transpose() * corners[0]);
  // Where corners lie on a line, a smaller simplex has the same nearest point.
  const bool is_inside = shares.allFinite() && (shares.array() >= 0.0).all() && shares.sum() <= 1.0;
  return {corners[0] + edges * shares, is_inside};
}

/// Returns the smallest part of a simplex that contains its point nearest to the origin, and that
/// point.
std::pair<Simplex, Vector3> NearestPart(const Simplex& corners) {
  std::pair<Simplex, Vector3> nearest;
  double least_m = std::numeric_limits<double>::infinity();
  const unsigned num_parts = 1U << corners.size();
  for (unsigned part = 1; part < num_parts; ++part) {
    Simplex chosen;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      if ((part >> i & 1U) != 0) chosen.Add(corners[i]);
    }
    const auto [point, is_inside] = NearestInSpan(chosen);
    if (!is_inside || !(point.norm() < least_m)) continue;
    least_m = point.norm();
    nearest = {std::move(chosen), point};
  }
  return nearest;
}

/// Unit vectors spread evenly over the sphere, along a spiral.
std::vector<Vector3> DirectionsAllAround() {
  constexpr int kNumDirections = 200;
  const double turn_rad = std::numbers::pi * (3.0 - std::sqrt(5.0));
  std::vector<Vector3> directions;
  for (int i = 0; i < kNumDirections; ++i) {
    const double z = 1.0 - (2.0 * i + 1.0) / kNumDirections;
    const double from_axis = std::sqrt(1.0 - z * z);
    directions.emplace_back(from_axis * std::cos(turn_rad * i), from_axis * std::sin(turn_rad * i),
                            z);
  }
  return directions;
}

/// The axes of both frames and their cross products, both ways.
std::vector<Vector3> DirectionsOfAxes(const Eigen::Matrix3d& turn) {
  std::vector<Vector3> directions;
  const auto add = [&](const Vector3& direction) {
    constexpr double kParallel = 1e-6;
    if (direction.norm() < kParallel) return;
    directions.push_back(direction.normalized());
    directions.push_back(-direction.normalized());
  };
  for (int i = 0; i < 3; ++i) {
    add(Vector3::Unit(i));
    add(turn.col(i));
    for (int k = 0; k < 3; ++k) add(Vector3::Unit(i).cross(turn.col(k)));
  }
  return directions;
}

/// The best move so far: its direction and its length.
struct Move {
  Vector3 direction = Vector3::UnitX();
  double length_m = std::numeric_limits<double>::infinity();

  /// Takes a direction if the move along it is shorter.
  bool Try(const Difference& difference, const Vector3& towards) {
    const double needed_m = towards.dot(difference.Farthest(towards));
    if (!(needed_m < length_m)) return false;
    length_m = needed_m;
    direction = towards;
    return true;
  }
};

/// Turns the move by ever smaller angles as long as it gets shorter.
void Refine(const Difference& difference, Move& move) {
  constexpr double kLargestTurn_rad = 0.1;
  constexpr double kSmallestTurn_rad = 1e-5;
  constexpr int kNumWays = 8;
  for (double turn_rad = kLargestTurn_rad; turn_rad > kSmallestTurn_rad;) {
    const Vector3 aside = move.direction.unitOrthogonal();
    const Vector3 across = move.direction.cross(aside);
    const Vector3 from = move.direction;
    bool is_shorter = false;
    for (int i = 0; i < kNumWays; ++i) {
      const double angle_rad = 2.0 * std::numbers::pi * i / kNumWays;
      const Vector3 way = std::cos(angle_rad) * aside + std::sin(angle_rad) * across;
      is_shorter = move.Try(difference, (from + turn_rad * way).normalized()) || is_shorter;
    }
    if (!is_shorter) turn_rad /= 2.0;
  }
}

}  // namespace

ConvexBody MakeConvexBody(std::vector<Vector3> corners_m) {
  Check(!corners_m.empty(), "a body has corners");
  ConvexBody body{std::move(corners_m), {}, false};
  for (const Vector3& corner : body.corners_m) body.box_m.extend(corner);
  constexpr std::size_t kNumBoxCorners = 8;
  body.is_box = body.corners_m.size() == kNumBoxCorners &&
                std::ranges::all_of(body.corners_m, [&](const Vector3& corner) {
                  return (corner.array() == body.box_m.min().array() ||
                          corner.array() == body.box_m.max().array())
                      .all();
                });
  return body;
}

double Gap_m(const ConvexBody& one,
             const Transform& one_from_other,
             const ConvexBody& other,
             double reach_m) {
  const Difference difference(one, one_from_other, other);
  // Each step needs one new corner; bodies with hundreds of them take some ten steps.
  constexpr int kMaxSteps = 100;
  Simplex simplex;
  simplex.Add(difference.AnyPoint());
  Vector3 nearest = simplex[0];
  for (int step = 0; step < kMaxSteps; ++step) {
    const double distance_m = nearest.norm();
    if (distance_m < kMeet_m) return 0.0;
    const Vector3 corner = difference.Farthest(-nearest);
    // The whole difference lies beyond the plane through this corner.
    const double at_least_m = corner.dot(nearest) / distance_m;
    if (at_least_m > reach_m) return reach_m;
    if (distance_m - at_least_m < kMeet_m) break;
    simplex.Add(corner);
    std::pair<Simplex, Vector3> next = NearestPart(simplex);
    // Rounding ends the descent.
    if (!(next.second.norm() < distance_m)) break;
    std::tie(simplex, nearest) = std::move(next);
    constexpr std::size_t kTetrahedron = 4;
    if (simplex.size() == kTetrahedron) return 0.0;
  }
  return std::min(nearest.norm(), reach_m);
}

double Depth_m(const ConvexBody& one,
               const Transform& one_from_other,
               const ConvexBody& other,
               double least_m) {
  const Difference difference(one, one_from_other, other);
  Move move;
  for (const Vector3& direction : DirectionsOfAxes(one_from_other.linear())) {
    move.Try(difference, direction);
    if (move.length_m <= least_m) return least_m;
  }
  if (!one.is_box || !other.is_box) {
    static const std::vector<Vector3> all_around = DirectionsAllAround();
    for (const Vector3& direction : all_around) {
      move.Try(difference, direction);
      if (move.length_m <= least_m) return least_m;
    }
    const Vector3 towards = one_from_other * other.box_m.center() - one.box_m.center();
    if (towards.norm() > 0.0) move.Try(difference, towards.normalized());
    Refine(difference, move);
  }
  return std::max(least_m, move.length_m);
}

}  // namespace railcast
