#include "generator/extras/insert/plan/plan_check.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "core/base/text.h"
#include "core/io/recording/plausibility.h"
#include "core/scan/firing.h"
#include "railcast/io/recording.h"
#include "railcast/lidar.h"

namespace railcast {
namespace {

/// What lies below this in a box is the ground that it stands on.
constexpr double kGround_m = 0.1;

/// An object's bounding box as the sensor sees it at a time.
struct SeenBox {
  Transform box_from_sensor;
  Eigen::AlignedBox3d bounds_m;
  Vector3 towards;          ///< Unit vector from the sensor to its middle.
  double distance_m{};      ///< To the middle.
  double cos_half_angle{};  ///< Cone about its bounding sphere; -1 from within it.
};

SeenBox SeeBox(const World& world,
               std::size_t object,
               const Transform& world_from_sensor,
               std::int64_t time_ns) {
  SeenBox seen;
  seen.box_from_sensor = world.WorldFromObject(object, time_ns).inverse() * world_from_sensor;
  seen.bounds_m = world.objects()[object].model->Bounds();
  const Vector3 middle_m = seen.box_from_sensor.inverse() * seen.bounds_m.center();
  const double radius_m = 0.5 * seen.bounds_m.diagonal().norm();
  seen.distance_m = middle_m.norm();
  seen.towards = middle_m / std::max(seen.distance_m, 1e-9);
  const double sine = radius_m / std::max(seen.distance_m, 1e-9);
  seen.cos_half_angle = sine < 1.0 ? std::sqrt(1.0 - sine * sine) : -1.0;
  return seen;
}

/// How far along a ray of unit length the box begins; nothing if it misses the box.
std::optional<double> EntryOf(const SeenBox& seen, const Vector3& direction) {
  if (seen.towards.dot(direction) < seen.cos_half_angle) return std::nullopt;
  const Vector3 origin_m = seen.box_from_sensor.translation();
  const Vector3 along = seen.box_from_sensor.linear() * direction;
  double entry_m = 0.0;
  double exit_m = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    // Where the ray is parallel to a pair of faces, the quotients are infinite with the right
    // signs, or NaN on a face itself, which neither min nor max takes over.
    const double a = (seen.bounds_m.min()[axis] - origin_m[axis]) / along[axis];
    const double b = (seen.bounds_m.max()[axis] - origin_m[axis]) / along[axis];
    entry_m = std::max(entry_m, std::min(a, b));
    exit_m = std::min(exit_m, std::max(a, b));
  }
  return entry_m <= exit_m ? std::optional(entry_m) : std::nullopt;
}

/// @return The mean time of the firings that aim at the box, since the frame began.
std::int64_t CountFirings(const ScanPattern& pattern,
                          double range_max_m,
                          const SeenBox& seen,
                          std::size_t frame,
                          ThingCheck& check) {
  if (seen.distance_m > range_max_m + 0.5 * seen.bounds_m.diagonal().norm()) return 0;
  std::size_t num_firings = 0;
  double sum_ns = 0.0;
  for (std::size_t i = 0; i < pattern.num_firings(); ++i) {
    const auto entry_m = EntryOf(seen, BeamDirection(pattern, i));
    if (!entry_m || *entry_m > range_max_m) continue;
    ++num_firings;
    sum_ns += pattern.time_ns[i];
  }
  if (num_firings == 0) return 0;
  ++check.num_frames_in_reach;
  if (num_firings > check.most_firings) {
    check.most_firings = num_firings;
    check.most_firings_frame = frame;
  }
  return std::llround(sum_ns / static_cast<double>(num_firings));
}

void CountRecorded(const Frame& frame, const SeenBox& seen, ThingCheck& check) {
  Eigen::AlignedBox3d inside_m = seen.bounds_m;
  inside_m.min().z() += std::min(kGround_m, 0.5 * inside_m.sizes().z());
  bool has_inside = false;
  for (std::size_t i = 0; i < frame.num_slots(); ++i) {
    const Vector3 point_m(frame.x[i], frame.y[i], frame.z[i]);
    const double range_m = point_m.norm();
    if (!(range_m > 0.0)) continue;
    const auto entry_m = EntryOf(seen, point_m / range_m);
    if (!entry_m) continue;
    ++check.num_points;
    if (range_m < *entry_m) ++check.num_points_before;
    if (!inside_m.contains(seen.box_from_sensor * point_m)) continue;
    ++check.num_points_inside;
    has_inside = true;
  }
  check.num_frames_inside += has_inside ? 1 : 0;
}

std::string PlaceText(const PlacedThing& place) {
  std::string text = "at chainage " + ShortText(place.s_m) + " m, " +
                     ShortText(std::abs(place.d_m)) + " m " + (place.d_m < 0.0 ? "right" : "left") +
                     ", " + ShortText(std::abs(place.h_m)) + " m " +
                     (place.h_m < 0.0 ? "below" : "above") + " the rails";
  if (place.is_on_ground) {
    text += place.has_ground
                ? ", on recorded ground (residual " + ShortText(place.ground_residual_m) + " m)"
                : ", where no ground was found";
  }
  return text + " (asked: " + place.asked + ")";
}

std::string PercentText(std::size_t part, std::size_t whole) {
  return ShortText(100.0 * static_cast<double>(part) / static_cast<double>(whole)) + " %";
}

std::string FoundText(const ThingCheck& thing, const PlanCheck& check) {
  if (thing.num_frames_in_reach == 0) {
    return "no firing aims at it in any of the " + NumberText(check.num_frames) + " frames";
  }
  std::string text = "aimed at in " + NumberText(thing.num_frames_in_reach) + " of " +
                     NumberText(check.num_frames) + " frames, by " +
                     NumberText(thing.most_firings) + " firings at most, in frame " +
                     NumberText(thing.most_firings_frame);
  if (thing.num_points == 0) return text + "; no recorded point in its direction";
  text += "; of " + NumberText(thing.num_points) + " recorded points in its direction " +
          PercentText(thing.num_points_before, thing.num_points) + " are before it";
  if (thing.num_points_inside == 0) return text + ", none inside it";
  return text + ", " + PercentText(thing.num_points_inside, thing.num_points) + " inside it, in " +
         NumberText(thing.num_frames_inside) + " of " + NumberText(check.num_frames_looked) +
         " frames: a recorded surface stands there";
}

}  // namespace

PlanCheck CheckPlan(const InsertPlan& plan,
                    const std::filesystem::path& recording,
                    const InsertRange& range,
                    const FiringFinder& finder) {
  constexpr std::size_t kMostLooked = 200;
  const LidarSpec& lidar = plan.scenario.lidar;
  const ScanPattern pattern = BuildScanPattern(lidar.scan);
  const Transform vehicle_from_sensor =
      VehicleFromSensor(lidar.mount) * NominalFromTrue(lidar.mount_error);
  const World& world = *plan.world;
  PlanCheck check;
  check.num_frames = range.num;
  for (const SceneObject& object : world.objects()) check.things.push_back({.name = object.name});
  const std::size_t stride = (check.num_frames + kMostLooked - 1) / kMostLooked;
  const auto opened = OpenRecording(recording);
  for (std::uint32_t i = 0; i < range.first; ++i) (void)opened->Next();
  for (std::size_t frame = range.first; frame < std::size_t{range.first} + range.num; ++frame) {
    const std::int64_t time_ns = plan.frame_times_ns.at(frame);
    const auto see = [&](std::size_t object, std::int64_t at_ns) {
      return SeeBox(world, object, world.WorldFromVehicle(at_ns) * vehicle_from_sensor, at_ns);
    };
    const auto read = opened->Next();
    std::optional<RecordedFrame> recorded;
    if (read && (frame - range.first) % stride == 0) {
      recorded = (*read)();
      static_cast<void>(CheckRanges(*recorded, opened->info(), lidar.range_max_m));
      recorded = finder.Find(std::move(*recorded)).recorded;
    }
    check.num_frames_looked += recorded ? 1 : 0;
    for (std::size_t i = 0; i < check.things.size(); ++i) {
      ThingCheck& thing = check.things[i];
      const std::int64_t later_ns =
          CountFirings(pattern, lidar.range_max_m, see(i, time_ns), frame, thing);
      if (recorded) CountRecorded(recorded->frame, see(i, time_ns + later_ns), thing);
    }
  }
  return check;
}

std::string PlanCheckText(const InsertPlan& plan, const PlanCheck& check) {
  std::string text;
  for (std::size_t i = 0; i < check.things.size(); ++i) {
    const ThingCheck& thing = check.things[i];
    text += thing.name + ":\n";
    if (i < plan.places.size()) text += "  " + PlaceText(plan.places[i]) + '\n';
    text += "  " + FoundText(thing, check) + '\n';
  }
  return text;
}

}  // namespace railcast
