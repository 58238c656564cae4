#include "core/rail/motion/path_draft.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/text.h"
#include "core/base/units.h"
#include "core/rail/network/turnout_place.h"

namespace railcast {
namespace {

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

}  // namespace

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
