#include "core/rail/motion/path_way.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/text.h"
#include "core/base/units.h"
#include "core/rail/line/line_place.h"
#include "core/rail/network/turnout_place.h"

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

constexpr double kLeastDistance_m = 0.01;
constexpr double kGreatestLength_m = 20'000.0;

/// The heading turns over four tenths of the object's length, but a person still turns gradually.
double FacingLength_m(double object_length_m) {
  constexpr double kShare = 0.4;
  return std::clamp(kShare * object_length_m, 0.5, 4.0);
}

/// Whether the path so far is within the ground.
bool IsPlaceOnGround(const PathGround& ground, const PathPlace& place) {
  return std::abs(place.d_m) <= ground.half_width_m && place.s_m >= 0.0 &&
         place.s_m <= ground.alignment.length_m();
}

/// Index of the point on the way to which the path leaves the ground; the number of points if it
/// stays on it.
std::size_t LeavesGroundBefore(const PathGround& ground, const PathCourse& course) {
  const std::vector<double>& points_along_m = course.points_along_m();
  for (std::size_t i = 0; i + 1 < points_along_m.size(); ++i) {
    const double length_m = points_along_m[i + 1] - points_along_m[i];
    const auto num_steps = static_cast<int>(std::ceil(length_m / PathCourse::kStep_m));
    for (int step = 0; step <= num_steps; ++step) {
      const double along_m = points_along_m[i] + length_m * step / num_steps;
      if (!IsPlaceOnGround(ground, course.At(along_m))) return i;
    }
  }
  return points_along_m.size() - 1;
}

void CheckTrigger(const PathGround& ground,
                  const PathSpec& path,
                  const std::string& pointer,
                  WorldFaults& faults) {
  if (!path.start_at_vehicle_s_m) return;
  const double trigger_s_m = *path.start_at_vehicle_s_m;
  const double now_s_m = ground.vehicle.ChainageAt(ground.begin_ns);
  const double ahead_m = ground.vehicle.reverse() ? now_s_m - trigger_s_m : trigger_s_m - now_s_m;
  if (ahead_m < 0.0) {
    faults.Add(pointer + "/start_at_vehicle_s_m",
               "must lie ahead of the vehicle, which begins at " + NumberText(now_s_m) + " m",
               NumberText(trigger_s_m));
  }
}

std::string PointPointer(const std::string& path_pointer, std::size_t point) {
  return path_pointer + "/points/" + std::to_string(point);
}

/// Checks what must be known before a course is made of the points.
void CheckPoints(const PathCourse::Start& start,
                 const PathSpec& path,
                 const std::string& path_pointer,
                 WorldFaults& faults) {
  const std::vector<double> distances_m = PathCourse::Distances_m(start, path);
  double length_m = 0.0;
  for (std::size_t i = 0; i < distances_m.size(); ++i) {
    length_m += distances_m[i];
    if (distances_m[i] >= kLeastDistance_m) continue;
    faults.Add(PointPointer(path_pointer, i),
               std::string("must be at least 0.01 m from ") +
                   (i == 0 ? "the object's own place" : "the point before it"));
  }
  if (length_m > kGreatestLength_m) {
    faults.Add(path_pointer + "/points", "must make a path of at most 20 km",
               ShortText(length_m / 1000.0) + " km");
  }
  const std::size_t doubles_back = PathCourse::DoublesBackAt(start, path);
  if (doubles_back < path.points.size()) {
    faults.Add(PointPointer(path_pointer, doubles_back),
               "must not lead straight back: let the path end there and give turns_back");
  }
}

/// The speed at a distance from where it is `speed_mps`, changing at a constant rate.
double SpeedAfter_mps(double speed_mps, double acceleration_mps2, double distance_m) {
  return std::sqrt(speed_mps * speed_mps + 2.0 * acceleration_mps2 * distance_m);
}

constexpr double kNever_s = std::numeric_limits<double>::infinity();

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

PathMotion::PathMotion(const PathSpec& path, const std::vector<double>& points_along_m)
    : phases_{Phase{}}, length_m_(points_along_m.back()) {
  std::vector<Stretch> there;
  for (std::size_t i = 0; i < path.points.size(); ++i) {
    const PathPoint& point = path.points[i];
    const bool is_last = i + 1 == path.points.size();
    there.push_back({points_along_m[i + 1] - points_along_m[i],
                     point.speed_mps.value_or(path.speed_mps), point.wait_s,
                     is_last || point.wait_s > 0.0, is_last && path.turns_back});
  }
  Append(there, path.acceleration_mps2);
  if (!path.turns_back) return;
  std::vector<Stretch> back;
  for (std::size_t i = there.size(); i-- > 0;) {
    back.push_back({there[i].length_m, there[i].speed_mps, i > 0 ? there[i - 1].wait_s : 0.0,
                    i == 0 || there[i - 1].stops, i == 0});
  }
  Append(back, path.acceleration_mps2);
  period_s_ = phases_.back().begin_s;
}

void PathMotion::Append(const std::vector<Stretch>& stretches, double acceleration_mps2) {
  // Speeds at the ends of the stretches: first what the stretches permit, then what can be reached
  // from the one before, then what permits slowing down to the one after.
  std::vector<double> speeds_mps{0.0};
  for (std::size_t i = 0; i < stretches.size(); ++i) {
    const double permitted_mps =
        stretches[i].stops ? 0.0 : std::min(stretches[i].speed_mps, stretches[i + 1].speed_mps);
    speeds_mps.push_back(
        std::min(permitted_mps,
                 SpeedAfter_mps(speeds_mps.back(), acceleration_mps2, stretches[i].length_m)));
  }
  for (std::size_t i = stretches.size(); i-- > 0;) {
    speeds_mps[i] = std::min(
        speeds_mps[i], SpeedAfter_mps(speeds_mps[i + 1], acceleration_mps2, stretches[i].length_m));
  }
  for (std::size_t i = 0; i < stretches.size(); ++i) {
    const Stretch& stretch = stretches[i];
    const double begin_mps = speeds_mps[i];
    const double end_mps = speeds_mps[i + 1];
    const double peak_mps =
        std::min(stretch.speed_mps, std::sqrt(0.5 * (begin_mps * begin_mps + end_mps * end_mps) +
                                              acceleration_mps2 * stretch.length_m));
    const double up_s = (peak_mps - begin_mps) / acceleration_mps2;
    const double down_s = (peak_mps - end_mps) / acceleration_mps2;
    const double cruise_m = stretch.length_m - 0.5 * (begin_mps + peak_mps) * up_s -
                            0.5 * (peak_mps + end_mps) * down_s;
    Append(up_s, acceleration_mps2, 0.0);
    if (cruise_m > 0.0 && peak_mps > 0.0) Append(cruise_m / peak_mps, 0.0, 0.0);
    Append(down_s, -acceleration_mps2, 0.0);
    phases_.back().speed_mps = end_mps;  // Exactly, whatever the rounding.
    if (!stretch.turns) {
      Append(stretch.wait_s, 0.0, 0.0);
    } else {
      Append(std::max(0.0, stretch.wait_s - kTurn_s), 0.0, 0.0);
      Append(kTurn_s, 0.0, std::numbers::pi / kTurn_s);
    }
  }
}

// The last phase gets its acceleration and a successor.
void PathMotion::Append(double duration_s, double acceleration_mps2, double turn_radps) {
  if (duration_s <= 0.0) return;
  Phase& last = phases_.back();
  last.acceleration_mps2 = acceleration_mps2;
  last.turn_radps = turn_radps;
  Phase next = last;
  next.begin_s += duration_s;
  next.walked_m += (last.speed_mps + 0.5 * acceleration_mps2 * duration_s) * duration_s;
  next.speed_mps += acceleration_mps2 * duration_s;
  next.turned_rad += turn_radps * duration_s;
  next.acceleration_mps2 = 0.0;
  next.turn_radps = 0.0;
  phases_.push_back(next);
}

PathMotion::State PathMotion::At(double time_s) const {
  double inside_s = std::max(0.0, time_s);
  double rounds = 0.0;
  if (period_s_ > 0.0) {
    rounds = std::floor(inside_s / period_s_);
    inside_s -= rounds * period_s_;
  }
  const auto after = std::ranges::upper_bound(phases_, inside_s, {}, &Phase::begin_s);
  const Phase& phase = *(after - 1);
  inside_s -= phase.begin_s;
  const double walked_m =
      phase.walked_m + (phase.speed_mps + 0.5 * phase.acceleration_mps2 * inside_s) * inside_s;
  return {.along_m = walked_m <= length_m_ ? walked_m : std::max(0.0, 2.0 * length_m_ - walked_m),
          .speed_mps = std::max(0.0, phase.speed_mps + phase.acceleration_mps2 * inside_s),
          .walked_m = walked_m + 2.0 * rounds * length_m_,
          .turned_rad = phase.turned_rad + phase.turn_radps * inside_s};
}

PathWay::PathWay(PathCourse course,
                 const PathSpec& path,
                 std::int64_t begin_ns,
                 const TrackPath& vehicle)
    : course_(std::make_shared<const PathCourse>(std::move(course))),
      motion_(path, course_->points_along_m()),
      trigger_s_m_(path.start_at_vehicle_s_m) {
  const double begin_s = SecondsFromNs(begin_ns);
  start_s_ = begin_s + path.start_s.value_or(0.0);
  if (trigger_s_m_) {
    start_s_ = std::max(begin_s, vehicle.TimeAt_s(*trigger_s_m_).value_or(kNever_s));
  }
}

PathWay PathWay::WithVehicle(const TrackPath& vehicle, std::int64_t from_ns) const {
  PathWay changed = *this;
  if (trigger_s_m_ && start_s_ > SecondsFromNs(from_ns)) {
    changed.start_s_ = vehicle.TimeAt_s(*trigger_s_m_).value_or(kNever_s);
  }
  return changed;
}

PathWay::State PathWay::At(std::int64_t time_ns) const {
  const PathMotion::State state = motion_.At(SecondsFromNs(time_ns) - start_s_);
  PathPlace place = course_->At(state.along_m);
  place.heading_rad += state.turned_rad;
  return {place, state.speed_mps, state.walked_m};
}

std::optional<PathWay> DraftPathWay(const PathGround& ground,
                                    const ObjectSpec& object,
                                    const TrackPath& place,
                                    const PathSubject& subject,
                                    WorldFaults& faults) {
  const PathSpec& path = *object.motion->path;
  const std::string path_pointer = subject.pointer + "/motion/path";
  if (!faults.AreKnown({path_pointer, subject.pointer + "/s_m", subject.pointer + "/d_m"})) {
    return std::nullopt;
  }
  const std::size_t num_faults = faults.errors.size();
  CheckTrigger(ground, path, path_pointer, faults);
  const PathCourse::Start start{ground.alignment, place.course(), object.s_m, object.d_m};
  CheckPoints(start, path, path_pointer, faults);
  if (faults.errors.size() > num_faults) return std::nullopt;
  PathCourse course(start, path, FacingLength_m(subject.length_m));
  const std::size_t left_before = LeavesGroundBefore(ground, course);
  if (left_before < path.points.size()) {
    faults.Add(PointPointer(path_pointer, left_before),
               "must be reached on the ground, within " + NumberText(ground.half_width_m) +
                   " m of the line, which is " + ShortText(ground.alignment.length_m()) +
                   " m long");
  }
  if (faults.errors.size() > num_faults) return std::nullopt;
  return PathWay(std::move(course), path, ground.begin_ns, ground.vehicle);
}

}  // namespace railcast
