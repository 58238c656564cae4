#include "core/fidelity/sample_frames.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

#include "core/scenario/track_limits.h"
#include "railcast/rail_world.h"

namespace railcast {
namespace {

constexpr std::size_t kMostObjects = 64;
// The courses of objects are first looked at in this many frames.
constexpr std::uint32_t kNumSteps = 256;

// Returns the first frame of [begin, end) for which `holds`, or `end`; it holds for all later ones.
template <typename Predicate>
std::uint32_t FirstWith(std::uint32_t begin, std::uint32_t end, const Predicate& holds) {
  return FirstFrameBeyond(begin, end, std::not_fn(holds));
}

/// The distance from the sensor to one object as a function of the frame.
class Course {
 public:
  Course(const Simulator& simulator, std::size_t object)
      : simulator_(simulator),
        object_(object),
        center_m_(simulator.world().objects()[object].model->Bounds().center()) {}

  /// Not below 1 m, so that ratios of distances mean something.
  [[nodiscard]] double Distance_m(std::uint32_t frame) const {
    const std::int64_t time_ns = simulator_.pattern().StampNs(frame);
    const Vector3 object_m = simulator_.world().WorldFromObject(object_, time_ns) * center_m_;
    const Vector3 sensor_m = simulator_.WorldFromSensor(time_ns).translation();
    return std::max((object_m - sensor_m).norm(), 1.0);
  }

  [[nodiscard]] std::uint32_t Nearest(std::uint32_t last_frame) const {
    const auto at = [&](std::uint32_t step) {
      return static_cast<std::uint32_t>(std::uint64_t{last_frame} * step / kNumSteps);
    };
    std::uint32_t best = 0;
    for (std::uint32_t step = 1; step <= kNumSteps; ++step) {
      if (Distance_m(at(step)) < Distance_m(at(best))) best = step;
    }
    const std::uint32_t end = at(std::min(best + 1, kNumSteps));
    // Between the steps beside it, the distance falls up to the nearest frame and then rises.
    return FirstWith(at(best == 0 ? 0 : best - 1), end, [&](std::uint32_t frame) {
      return Distance_m(frame + 1) >= Distance_m(frame);
    });
  }

 private:
  const Simulator& simulator_;
  std::size_t object_;
  Vector3 center_m_;
};

/// A frame in which an object matters.
struct Event {
  const Course* course;
  std::uint32_t frame;
  double distance_m;
};

std::vector<Event> EventsOf(const std::vector<Course>& courses,
                            double range_max_m,
                            std::uint32_t last_frame) {
  std::vector<Event> events;
  for (const Course& course : courses) {
    const std::uint32_t nearest = course.Nearest(last_frame);
    const double nearest_m = course.Distance_m(nearest);
    if (nearest_m > range_max_m) continue;
    events.push_back({&course, nearest, nearest_m});
    const double near_m = 0.5 * range_max_m;
    if (nearest_m > near_m || course.Distance_m(0) <= near_m) continue;
    const std::uint32_t comes_near = FirstWith(
        0, nearest, [&](std::uint32_t frame) { return course.Distance_m(frame) <= near_m; });
    events.push_back({&course, comes_near, course.Distance_m(comes_near)});
  }
  return events;
}

bool Serves(std::uint32_t frame, const Event& event) {
  constexpr double kAboutAsFar = 1.5;
  const double ratio = event.course->Distance_m(frame) / event.distance_m;
  return ratio <= kAboutAsFar && ratio >= 1.0 / kAboutAsFar;
}

std::vector<Course> CoursesOf(const Simulator& simulator) {
  std::vector<Course> courses;
  const std::vector<SceneObject>& objects = simulator.world().objects();
  const std::size_t step =
      std::max<std::size_t>((objects.size() + kMostObjects - 1) / kMostObjects, 1);
  for (std::size_t i = 0; i < objects.size(); i += step) {
    if (!objects[i].is_ego) courses.emplace_back(simulator, i);
  }
  return courses;
}

/// The first frame from which on no barrier of a level crossing moves.
std::uint32_t FirstFrameOfStillBarriers(const WorldSpec& world, const ScanPattern& pattern) {
  double last_s = 0.0;
  for (const StructureSpec& structure : world.structures) {
    const auto* crossing = std::get_if<LevelCrossingSpec>(&structure);
    if (crossing == nullptr || crossing->barrier_angles_deg.empty()) continue;
    last_s = std::max(last_s, crossing->barrier_angles_deg.back().time_s);
  }
  return static_cast<std::uint32_t>(
      std::min(std::ceil(last_s * pattern.rate_hz), static_cast<double>(pattern.LastFrame())));
}

}  // namespace

std::uint32_t LastFrameOfRun(const ScenarioSpec& scenario,
                             const Simulator& simulator,
                             int num_frames) {
  const ScanPattern& pattern = simulator.pattern();
  const auto* const world = dynamic_cast<const RailWorld*>(&simulator.world());
  // The world of a host program has no tracks that could end.
  constexpr double kHostRun_s = 3.0;
  if (world == nullptr) return static_cast<std::uint32_t>(kHostRun_s * pattern.rate_hz);
  const std::uint32_t last = LastFrameOnTracks(scenario, *world, pattern, pattern.LastFrame());
  const auto are_at_rest = [&](std::uint32_t frame) {
    constexpr double kRest_m = 1e-3;
    const std::int64_t now_ns = pattern.StampNs(frame);
    const std::int64_t end_ns = pattern.StampNs(last);
    const auto rests = [&](auto chainage_m) {
      return std::abs(chainage_m(end_ns) - chainage_m(now_ns)) < kRest_m;
    };
    if (!rests([&](std::int64_t ns) { return world->VehicleChainage_m(ns); })) return false;
    for (std::size_t i = 0; i < world->objects().size(); ++i) {
      if (world->objects()[i].is_ego) continue;
      if (!rests([&](std::int64_t ns) { return world->ObjectChainage_m(i, ns); })) return false;
    }
    return true;
  };
  return std::max({FirstWith(0, last, are_at_rest),
                   std::min(last, FirstFrameOfStillBarriers(scenario.world, pattern)),
                   std::min(last, static_cast<std::uint32_t>(num_frames - 1))});
}

std::vector<std::uint32_t> SpreadFrames(std::uint32_t last_frame, int num_frames) {
  const std::uint64_t length = std::uint64_t{last_frame} + 1;
  const std::uint64_t num = std::min(static_cast<std::uint64_t>(num_frames), length);
  std::vector<std::uint32_t> frames;
  for (std::uint64_t i = 0; i < num; ++i) {
    frames.push_back(static_cast<std::uint32_t>((2 * i + 1) * length / (2 * num)));
  }
  return frames;
}

std::vector<std::uint32_t> FramesAtObjects(const ScenarioSpec& scenario,
                                           const Simulator& simulator,
                                           std::uint32_t last_frame,
                                           int num_most) {
  const std::vector<Course> courses = CoursesOf(simulator);
  std::vector<Event> left = EventsOf(courses, scenario.lidar.range_max_m, last_frame);
  std::vector<std::uint32_t> frames;
  while (!left.empty() && frames.size() < static_cast<std::size_t>(num_most)) {
    std::uint32_t best = left.front().frame;
    std::ptrdiff_t most = 0;
    for (const Event& candidate : left) {
      const auto num = std::ranges::count_if(
          left, [&](const Event& event) { return Serves(candidate.frame, event); });
      if (num > most || (num == most && candidate.frame < best)) {
        most = num;
        best = candidate.frame;
      }
    }
    frames.push_back(best);
    std::erase_if(left, [&](const Event& event) { return Serves(best, event); });
  }
  std::ranges::sort(frames);
  return frames;
}

std::vector<std::uint32_t> ApproachFrames(const ScenarioSpec& scenario,
                                          const Simulator& simulator,
                                          int num_frames) {
  constexpr double kLeastRatio = 1.5;
  const std::uint32_t last = LastFrameOfRun(scenario, simulator, num_frames);
  const std::vector<Course> courses = CoursesOf(simulator);
  const Course* most = nullptr;
  double most_ratio = kLeastRatio;
  const auto farthest_m = [&](const Course& course) {
    return std::min(course.Distance_m(0), scenario.lidar.range_max_m);
  };
  for (const Course& course : courses) {
    const double ratio = farthest_m(course) / course.Distance_m(course.Nearest(last));
    if (ratio <= most_ratio) continue;
    most_ratio = ratio;
    most = &course;
  }
  if (most == nullptr) return {};
  const std::uint32_t nearest = most->Nearest(last);
  std::set<std::uint32_t> frames;
  for (int i = 0; i < num_frames; ++i) {
    const double way = static_cast<double>(i) / (num_frames - 1);
    const double distance_m = farthest_m(*most) * std::pow(most_ratio, -way);
    frames.insert(FirstWith(
        0, nearest, [&](std::uint32_t frame) { return most->Distance_m(frame) <= distance_m; }));
  }
  return {frames.begin(), frames.end()};
}

std::vector<std::uint32_t> SampleFrames(const ScenarioSpec& scenario,
                                        const Simulator& simulator,
                                        int num_frames) {
  const std::uint32_t last = LastFrameOfRun(scenario, simulator, num_frames);
  const std::vector<std::uint32_t> at_objects =
      FramesAtObjects(scenario, simulator, last, num_frames / 2);
  const std::vector<std::uint32_t> spread =
      SpreadFrames(last, num_frames - static_cast<int>(at_objects.size()));
  std::set<std::uint32_t> frames(spread.begin(), spread.end());
  frames.insert(at_objects.begin(), at_objects.end());
  return {frames.begin(), frames.end()};
}

}  // namespace railcast
