#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/rail/base/world_faults.h"
#include "core/rail/line/track_course.h"
#include "core/rail/motion/track_path.h"
#include "railcast/alignment.h"
#include "railcast/objects.h"
#include "railcast/world_spec.h"

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

/// Progress along a path as a function of time, in closed form.
///
/// The object sets off from rest, travels each stretch at its speed and stops at points where it
/// waits and at the last one. It changes its speed at the path's constant acceleration: up after a
/// point, down before it. One that goes to and fro turns on the spot at either end, within
/// kTurn_s or while it waits there.
class PathMotion {
 public:
  static constexpr double kTurn_s = 1.0;

  struct State {
    double along_m{};     ///< From the start of the path.
    double speed_mps{};   ///< >= 0.
    double walked_m{};    ///< Distance covered so far, to and fro.
    double turned_rad{};  ///< By which it has turned round at ends: counterclockwise.
  };

  /// @param points_along_m Distances of the points from the start, which is the first (PathCourse).
  PathMotion(const PathSpec& path, const std::vector<double>& points_along_m);

  /// @param time_s Since the object set off; before, it stands at the start.
  [[nodiscard]] State At(double time_s) const;

 private:
  struct Phase {
    double begin_s{};
    double walked_m{};
    double speed_mps{};
    double acceleration_mps2{};
    double turn_radps{};  ///< Rate at which the object turns on the spot.
    double turned_rad{};  ///< At the beginning.
  };
  struct Stretch {
    double length_m{};
    double speed_mps{};  ///< Aspired to.
    double wait_s{};     ///< At its end.
    bool stops{};        ///< At its end.
    bool turns{};        ///< At its end.
  };
  void Append(const std::vector<Stretch>& stretches, double acceleration_mps2);
  void Append(double duration_s, double acceleration_mps2, double turn_radps);

  std::vector<Phase> phases_;
  double length_m_{};
  double period_s_{};  ///< 0 = it does not turn back.
};

/// The motion of an object along a path of its own: a course, progress on it, and when it begins.
class PathWay {
 public:
  /// @param begin_ns Time at which the path's own time is 0.
  /// @param vehicle The sensor's vehicle, which may set the object off.
  PathWay(PathCourse course, const PathSpec& path, std::int64_t begin_ns, const TrackPath& vehicle);

  /// The same way if the vehicle has another motion from `from_ns` on.
  [[nodiscard]] PathWay WithVehicle(const TrackPath& vehicle, std::int64_t from_ns) const;

  struct State {
    PathPlace place;     ///< Its heading is the object's.
    double speed_mps{};  ///< >= 0.
    double walked_m{};   ///< Distance covered so far.
  };
  [[nodiscard]] State At(std::int64_t time_ns) const;

 private:
  std::shared_ptr<const PathCourse> course_;
  PathMotion motion_;
  std::optional<double> trigger_s_m_;
  double start_s_{};  ///< Absolute; infinite if the object never sets off.
};

/// What paths are made on.
struct PathGround {
  const Alignment& alignment;
  double half_width_m{};     ///< Half the ground's width, on either side of the alignment.
  const TrackPath& vehicle;  ///< The sensor's vehicle.
  std::int64_t begin_ns{};   ///< When the paths' own time is 0.
};

/// The object that a path is for.
struct PathSubject {
  double length_m{};           ///< Over some of which it turns at corners.
  const std::string& pointer;  ///< With which faults begin.
};

/// Makes the way of an object whose motion has a path, or nothing if there is a fault.
/// @param place The object on its track, standing.
[[nodiscard]] std::optional<PathWay> DraftPathWay(const PathGround& ground,
                                                  const ObjectSpec& object,
                                                  const TrackPath& place,
                                                  const PathSubject& subject,
                                                  WorldFaults& faults);

}  // namespace railcast
