#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "core/rail/line/track_course.h"
#include "railcast/alignment.h"
#include "railcast/objects.h"

namespace railcast {

/// Where something on a path is and which way it faces.
struct PathPlace {
  Eigen::Vector2d position_m;  ///< In the world, in plan.
  double heading_rad{};        ///< Counterclockwise from east, ahead on the path.
  double s_m{};                ///< Chainage of the alignment beside it.
  double d_m{};                ///< Left of the alignment.
  double rail_height_m{};      ///< Height in the world of the alignment's top of rail beside it.
};

/// The course of a path in plan: from an object's place through the points of a path.
///
/// Between two points in track coordinates it keeps to them, so that it follows the track's curves;
/// where either is a point of the world it is straight. A smooth path is a centripetal Catmull-Rom
/// spline through all points (Yuksel, Schaefer and Keyser 2011). It is kept as a polyline with
/// vertices at most kStep_m apart, which in a curve of 10 m radius is 0.8 mm beside the curve.
class PathCourse {
 public:
  static constexpr double kStep_m = 0.25;

  /// The track in whose coordinates the points are given, and the object's place on it.
  struct Start {
    const Alignment& alignment;
    const TrackCourse& course;
    double s_m{};
    double d_m{};
  };
  /// Straight distances between the points, the object's place being the first.
  [[nodiscard]] static std::vector<double> Distances_m(const Start& start, const PathSpec& path);
  /// Index of the first point at which the path leads straight back to where it comes from, within
  /// 1 degree; the number of points if there is none.
  [[nodiscard]] static std::size_t DoublesBackAt(const Start& start, const PathSpec& path);

  /// @pre No two points are at one place.
  /// @param facing_m Length over which the heading turns at a corner; half of it before, half
  /// after.
  PathCourse(const Start& start, const PathSpec& path, double facing_m);

  [[nodiscard]] double length_m() const { return vertices_.back().along_m; }
  /// Distances from the start to the points, the start itself included.
  [[nodiscard]] const std::vector<double>& points_along_m() const { return points_along_m_; }
  /// @param along_m From the start; clamped to the path.
  [[nodiscard]] PathPlace At(double along_m) const;

 private:
  struct Vertex {
    Eigen::Vector2d position_m;
    double along_m{};
    double s_m{};
    double d_m{};
    double rail_height_m{};
  };
  void Add(const Alignment& alignment, const Eigen::Vector2d& position_m, double near_s_m);
  [[nodiscard]] Vertex Between(double along_m) const;

  std::vector<Vertex> vertices_;
  std::vector<double> points_along_m_;
  double facing_m_;
};

}  // namespace railcast
