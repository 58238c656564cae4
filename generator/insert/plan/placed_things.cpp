#include "generator/insert/plan/placed_things.h"

#include <cstddef>
#include <string>

#include "core/base/error.h"
#include "core/base/text.h"

namespace railcast {
namespace {

/// What places are turned with.
struct PlacesOfRun {
  const RecordedWay& way;
  const RecordedLine& line;
  Transform vehicle_from_sensor;
  double length_m{};  ///< Of the alignment.
};

void CountMotionFrom(double zero_s_m, std::optional<MotionSpec>& motion) {
  if (!motion) return;
  for (SpeedPoint& point : motion->profile) {
    if (point.s_m) *point.s_m += zero_s_m;
  }
  if (!motion->path) return;
  for (PathPoint& point : motion->path->points) {
    if (point.s_m) *point.s_m += zero_s_m;
  }
  if (motion->path->start_at_vehicle_s_m) *motion->path->start_at_vehicle_s_m += zero_s_m;
}

/// The place in the world of x_m and y_m in the sensor's axes, where they meet the vehicle's plane
/// z = 0.
Vector3 PlaceBeforeSensor(const PlacesOfRun& run, std::size_t frame, double x_m, double y_m) {
  const Transform& vehicle_from_sensor = run.vehicle_from_sensor;
  const double height_m = (vehicle_from_sensor * Vector3(x_m, y_m, 0.0)).z();
  const double z_m = -height_m / vehicle_from_sensor.linear()(2, 2);
  return run.way.at_frames[frame] * (vehicle_from_sensor * Vector3(x_m, y_m, z_m));
}

void PlaceByFrame(const PlacesOfRun& run,
                  const std::string& pointer,
                  ObjectSpec& object,
                  ErrorList& errors) {
  const std::size_t frame = *object.frame;
  const std::size_t num_frames = run.way.at_frames.size();
  if (frame >= num_frames) {
    errors.Add({pointer + "/frame",
                "must be a frame of the recording, 0 to " + NumberText(num_frames - 1),
                NumberText(frame)});
    return;
  }
  if (!object.x_m) {
    const double ahead_m = run.line.faces_up[frame] ? object.s_m : -object.s_m;
    object.s_m = run.line.at_frames_m[frame] + ahead_m;
    return;
  }
  if (run.line.alignment.map) {
    errors.Add({pointer + "/x_m",
                "must not be given beside frame: the alignment has a map, in which x_m counts",
                NumberText(*object.x_m)});
    return;
  }
  const Vector3 place_m = PlaceBeforeSensor(run, frame, *object.x_m, *object.y_m);
  object.x_m = place_m.x();
  object.y_m = place_m.y();
}

void PlaceThing(const PlacesOfRun& run,
                const std::string& pointer,
                ObjectSpec& object,
                ErrorList& errors) {
  const double zero_s_m = run.line.zero_s_m;
  const double given_s_m = object.s_m;
  const bool is_on_line = !object.x_m && !object.longitude_deg;
  const std::size_t num_before = errors.size();
  if (object.frame) {
    PlaceByFrame(run, pointer, object, errors);
  } else if (is_on_line) {
    object.s_m += zero_s_m;
  }
  object.frame.reset();
  CountMotionFrom(zero_s_m, object.motion);
  const bool may_begin_beyond = object.motion && !object.motion->path;
  if (!is_on_line || may_begin_beyond || errors.size() > num_before) return;
  if (object.s_m >= 0.0 && object.s_m <= run.length_m) return;
  errors.Add({pointer + "/s_m",
              "must put it on the line, between chainage " + ShortText(-zero_s_m) + " and " +
                  ShortText(run.length_m - zero_s_m) + " m",
              NumberText(given_s_m)});
}

/// Along a driven path, chainages of tracks would have to be turned, too.
void CheckTracks(const ScenarioSpec& plan, ErrorList& errors) {
  for (std::size_t i = 0; i < plan.world.tracks.size(); ++i) {
    const TrackSpec& track = plan.world.tracks[i];
    TrackSpec simple;
    simple.name = track.name;
    simple.offset_m = track.offset_m;
    simple.sleeper = track.sleeper;
    simple.electrified = track.electrified;
    if (track == simple) continue;
    errors.Add({plan.sources.Place("/world/tracks/" + std::to_string(i)),
                "must have only name and offset_m beside a driven path; others need "
                "/world/recording/alignment",
                Quoted(track.name)});
  }
}

}  // namespace

std::string AskedPlace(const ObjectSpec& object) {
  std::string asked;
  const auto add = [&](const char* key, const auto& value) {
    asked += (asked.empty() ? "" : ", ") + std::string(key) + " " + NumberText(value);
  };
  if (object.frame) add("frame", *object.frame);
  if (object.x_m) {
    add("x_m", *object.x_m);
    add("y_m", object.y_m.value_or(0.0));
  } else if (object.longitude_deg) {
    add("longitude_deg", *object.longitude_deg);
    add("latitude_deg", object.latitude_deg.value_or(0.0));
  } else {
    add("s_m", object.s_m);
    add("d_m", object.d_m);
  }
  if (object.h_m) add("h_m", *object.h_m);
  return asked;
}

void PlaceThings(const RecordedWay& way, const RecordedLine& line, ScenarioSpec& plan) {
  ErrorList errors;
  const PlacesOfRun run{
      way, line, VehicleFromSensor(plan.lidar.mount) * NominalFromTrue(plan.lidar.mount_error),
      Alignment(line.alignment).length_m()};
  if (line.zero_s_m != 0.0) CheckTracks(plan, errors);
  for (std::size_t i = 0; i < plan.world.objects.size(); ++i) {
    const std::string pointer = "/world/objects/" + std::to_string(i);
    ErrorList faults;
    PlaceThing(run, pointer, plan.world.objects[i], faults);
    for (const Fault& fault : faults.faults()) errors.Add(plan.sources.Locate(fault, ""));
  }
  for (TrainSpec& train : plan.world.trains) {
    train.s_m += line.zero_s_m;
    CountMotionFrom(line.zero_s_m, train.motion);
  }
  errors.ThrowIfAny();
}

}  // namespace railcast
