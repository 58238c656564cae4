#include "core/rail/motion/path_course.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/rail/line/line_place.h"

namespace railcast {
namespace {

/// A point that the path leads through.
struct Node {
  Eigen::Vector2d position_m;
  double near_s_m{};                          ///< A chainage near it.
  std::optional<Eigen::Vector2d> in_track{};  ///< Chainage and distance from the track's axis.
};

Eigen::Vector2d PlaceInPlan(const PathCourse::Start& start, double s_m, double d_m) {
  return start.course.WorldFromTrack(start.alignment, s_m, d_m, 0.0).translation().head<2>();
}

std::vector<Node> NodesOf(const PathCourse::Start& start, const PathSpec& path) {
  std::vector<Node> nodes;
  nodes.push_back(
      {PlaceInPlan(start, start.s_m, start.d_m), start.s_m, Eigen::Vector2d(start.s_m, start.d_m)});
  for (const PathPoint& point : path.points) {
    if (point.s_m) {
      nodes.push_back({PlaceInPlan(start, *point.s_m, *point.d_m), *point.s_m,
                       Eigen::Vector2d(*point.s_m, *point.d_m)});
    } else {
      const Eigen::Vector2d position_m(*point.x_m, *point.y_m);
      const double s_m = NearestOnLine(start.alignment, position_m).front().s_m;
      nodes.push_back({position_m, s_m, std::nullopt});
    }
  }
  return nodes;
}

/// A point of the centripetal Catmull-Rom spline between the inner two of four points, by the
/// pyramid of Barry and Goldman (1988).
Eigen::Vector2d OnSpline(const std::array<Eigen::Vector2d, 4>& points_m, double share) {
  std::array<double, 4> knots{};
  for (std::size_t i = 1; i < points_m.size(); ++i) {
    knots[i] = knots[i - 1] + std::sqrt((points_m[i] - points_m[i - 1]).norm());
  }
  const double knot = std::lerp(knots[1], knots[2], share);
  std::array<Eigen::Vector2d, 4> level = points_m;
  for (std::size_t span = 1; span < points_m.size(); ++span) {
    // The last two steps of the pyramid use the inner knots only.
    for (std::size_t i = 0; i + span < points_m.size(); ++i) {
      const std::size_t begin = span == 3 ? 1 : i;
      const std::size_t end = span == 3 ? 2 : i + span;
      const double part = (knot - knots[begin]) / (knots[end] - knots[begin]);
      level[i] = (1.0 - part) * level[i] + part * level[i + 1];
    }
  }
  return level[0];
}

/// The four points of the spline from node `begin` to the next. Beyond either end of the path, the
/// point that continues it straight on.
std::array<Eigen::Vector2d, 4> AroundSegment(const std::vector<Node>& nodes, std::size_t begin) {
  const Eigen::Vector2d& from = nodes[begin].position_m;
  const Eigen::Vector2d& to = nodes[begin + 1].position_m;
  return {
      begin > 0 ? nodes[begin - 1].position_m : Eigen::Vector2d(2.0 * from - to), from, to,
      begin + 2 < nodes.size() ? nodes[begin + 2].position_m : Eigen::Vector2d(2.0 * to - from)};
}

}  // namespace

std::vector<double> PathCourse::Distances_m(const Start& start, const PathSpec& path) {
  const std::vector<Node> nodes = NodesOf(start, path);
  std::vector<double> distances_m;
  for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
    distances_m.push_back((nodes[i + 1].position_m - nodes[i].position_m).norm());
  }
  return distances_m;
}

std::size_t PathCourse::DoublesBackAt(const Start& start, const PathSpec& path) {
  constexpr double kCosOfTurn = -0.99985;  // 179 degrees.
  const std::vector<Node> nodes = NodesOf(start, path);
  for (std::size_t i = 1; i + 1 < nodes.size(); ++i) {
    const Eigen::Vector2d there_m = nodes[i].position_m - nodes[i - 1].position_m;
    const Eigen::Vector2d on_m = nodes[i + 1].position_m - nodes[i].position_m;
    if (there_m.dot(on_m) < kCosOfTurn * there_m.norm() * on_m.norm()) return i - 1;
  }
  return path.points.size();
}

PathCourse::PathCourse(const Start& start, const PathSpec& path, double facing_m)
    : facing_m_(facing_m) {
  const std::vector<Node> nodes = NodesOf(start, path);
  Add(start.alignment, nodes.front().position_m, nodes.front().near_s_m);
  points_along_m_.push_back(0.0);
  for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
    const Node& from = nodes[i];
    const Node& to = nodes[i + 1];
    const double length_m = (to.position_m - from.position_m).norm();
    // A curve through the points is longer than the straight line, but hardly twice as long.
    const int num_steps = std::max(1, static_cast<int>(std::ceil(2.0 * length_m / kStep_m)));
    for (int step = 1; step <= num_steps; ++step) {
      const double share = 1.0 * step / num_steps;
      Eigen::Vector2d position_m = from.position_m + share * (to.position_m - from.position_m);
      if (path.is_smooth && length_m > 0.0) {
        position_m = OnSpline(AroundSegment(nodes, i), share);
      } else if (from.in_track && to.in_track) {
        const Eigen::Vector2d place_m = *from.in_track + share * (*to.in_track - *from.in_track);
        position_m = PlaceInPlan(start, place_m.x(), place_m.y());
      }
      const double near_s_m =
          step == num_steps && !to.in_track ? to.near_s_m : vertices_.back().s_m;
      Add(start.alignment, position_m, near_s_m);
    }
    points_along_m_.push_back(vertices_.back().along_m);
  }
}

void PathCourse::Add(const Alignment& alignment,
                     const Eigen::Vector2d& position_m,
                     double near_s_m) {
  const PlaceBesideLine place =
      PlaceOnLine(alignment, {position_m.x(), position_m.y(), 0.0}, near_s_m);
  const double along_m = vertices_.empty() ? 0.0
                                           : vertices_.back().along_m +
                                                 (position_m - vertices_.back().position_m).norm();
  vertices_.push_back({position_m, along_m, place.s_m, place.d_m, -place.h_m});
}

PathCourse::Vertex PathCourse::Between(double along_m) const {
  const double clamped_m = std::clamp(along_m, 0.0, length_m());
  auto end = std::ranges::upper_bound(vertices_, clamped_m, {}, &Vertex::along_m);
  if (end == vertices_.end()) return vertices_.back();
  const Vertex& after = *end;
  const Vertex& before = *(end - 1);
  const double share = (clamped_m - before.along_m) / (after.along_m - before.along_m);
  return {before.position_m + share * (after.position_m - before.position_m), clamped_m,
          std::lerp(before.s_m, after.s_m, share), std::lerp(before.d_m, after.d_m, share),
          std::lerp(before.rail_height_m, after.rail_height_m, share)};
}

PathPlace PathCourse::At(double along_m) const {
  const Vertex here = Between(along_m);
  Eigen::Vector2d ahead_m = Between(here.along_m + 0.5 * facing_m_).position_m -
                            Between(here.along_m - 0.5 * facing_m_).position_m;
  // Where the path turns back on itself, what comes next counts.
  constexpr double kLeast_m = 1e-3;
  if (ahead_m.norm() < kLeast_m) {
    ahead_m = Between(here.along_m + kStep_m).position_m - here.position_m;
  }
  return {here.position_m, std::atan2(ahead_m.y(), ahead_m.x()), here.s_m, here.d_m,
          here.rail_height_m};
}

}  // namespace railcast
