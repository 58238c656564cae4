#include "analysis/detectability/approach.h"

#include <cmath>

#include "core/base/text.h"
#include "core/base/units.h"
#include "railcast/rail_world.h"
#include "railcast/scenario.h"

namespace railcast {
namespace {

// Mean speed from the poses at the start and end of the scan.
double SpeedOf(const Frame& frame) {
  const Vector3 way_m =
      frame.world_from_sensor_end.translation() - frame.world_from_sensor.translation();
  return way_m.norm() / SecondsFromNs(frame.duration_ns);
}

double GradientOf(const Frame& frame, const Transform& vehicle_from_sensor) {
  const Vector3 forward = frame.world_from_sensor.linear() *
                          vehicle_from_sensor.linear().transpose() * Vector3::UnitX();
  return forward.z() / std::hypot(forward.x(), forward.y());
}

double ApproachOf(const RecordedObject& object, const Frame& frame) {
  const Vector3 to_object = object.sensor_from_box.translation();
  if (to_object.isZero()) return 0.0;
  const Vector3 velocity_sensor_mps =
      frame.world_from_sensor.linear().transpose() * object.velocity_world_mps;
  return -velocity_sensor_mps.dot(to_object.normalized());
}

}  // namespace

double DistanceToBox(const Vector3& point_m, const Vector3& size_m) {
  return (point_m.cwiseAbs() - 0.5 * size_m).cwiseMax(0.0).norm();
}

void AddFrame(const RecordedFrame& recorded,
              const Transform& vehicle_from_sensor,
              const OwnTrack& own_track,
              RunCourses& courses) {
  const Frame& frame = recorded.frame;
  const double speed_mps = SpeedOf(frame);
  const double gradient = GradientOf(frame, vehicle_from_sensor);
  const Transform world_from_vehicle = frame.world_from_sensor * vehicle_from_sensor.inverse();
  for (const RecordedObject& object : recorded.objects) {
    ObjectCourse& course = courses.objects[object.name];
    course.type = object.type;
    course.label = object.label;
    const GaugeClearance clearance = own_track.ClearanceAhead(
        world_from_vehicle, frame.world_from_sensor * object.sensor_from_box, object.size_m);
    const Vector3 sensor_in_box_m = object.sensor_from_box.inverse().translation();
    course.sightings.push_back({.frame = courses.num_frames,
                                .distance_m = DistanceToBox(sensor_in_box_m, object.size_m),
                                .points = object.points,
                                .speed_mps = speed_mps,
                                .gradient = gradient,
                                .approach_mps = ApproachOf(object, frame),
                                .is_in_way = clearance.is_inside,
                                .from_axis_m = clearance.from_axis_m});
  }
  ++courses.num_frames;
}

RunCourses FollowObjects(Recording& recording, const std::function<void(std::size_t)>& on_frame) {
  const RecordingInfo& info = recording.info();
  if (!info.scenario) {
    throw InputError(
        ShownPath(info.source) +
        ": must be a sequence directory, which says what was seen of its objects (got " +
        info.kind + ")");
  }
  const Transform vehicle_from_sensor = VehicleFromSensor(info.scenario->lidar.mount);
  const OwnTrack own_track(*MakeWorld(*info.scenario), info.scenario->world.catenary);
  RunCourses courses;
  while (const auto read = recording.Next()) {
    const RecordedFrame recorded = (*read)();
    if (recorded.frame.duration_ns == 0) {
      throw InputError(recorded.name + ": a scan must take time to tell the sensor's speed");
    }
    AddFrame(recorded, vehicle_from_sensor, own_track, courses);
    on_frame(courses.num_frames);
  }
  return courses;
}

}  // namespace railcast
