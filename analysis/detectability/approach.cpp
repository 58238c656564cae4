#include "analysis/detectability/approach.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/units.h"
#include "railcast/rail_world.h"
#include "railcast/scenario.h"

namespace railcast {
namespace {

constexpr double kAxisStep_m = 5.0;
/// Boxes are cut into pieces of this length; within one the track leaves its tangent by at most
/// 1 m^2 / (2 R): 5 mm at R = 100 m.
constexpr double kPiece_m = 2.0;
constexpr double kMaxPieces = 64.0;

/// Number of pieces that a length is cut into.
int PiecesOf(double length_m) {
  return static_cast<int>(std::clamp(std::ceil(length_m / kPiece_m), 1.0, kMaxPieces));
}

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

OwnTrack::OwnTrack(const ScenarioSpec& scenario) : OwnTrack(scenario, *MakeWorld(scenario)) {}

OwnTrack::OwnTrack(const ScenarioSpec& scenario,
                   const RailWorld& world,
                   std::vector<GaugePart> gauge)
    : alignment_(world.alignment()), track_(world.vehicle_course()), gauge_(std::move(gauge)) {
  if (gauge_.empty()) {
    gauge_ = StructureGauge(ContactHeightOver_m(world.vehicle_track(), scenario.world.catenary));
  }
  for (double s_m = track_.begin_s_m(); s_m < track_.end_s_m() + kAxisStep_m; s_m += kAxisStep_m) {
    axis_m_.emplace_back(track_.WorldFromTrack(alignment_, s_m).translation());
  }
}

double OwnTrack::ChainageNear_m(const Vector3& world_m) const {
  const auto nearest = std::ranges::min_element(
      axis_m_, {}, [&](const Vector3& point_m) { return (point_m - world_m).squaredNorm(); });
  return Refined_m(
      track_.begin_s_m() + kAxisStep_m * static_cast<double>(nearest - axis_m_.begin()), world_m);
}

// Newton's method.
double OwnTrack::Refined_m(double s_m, const Vector3& world_m) const {
  constexpr int kNumSteps = 3;
  for (int i = 0; i < kNumSteps; ++i) {
    s_m += (track_.WorldFromTrack(alignment_, s_m).inverse() * world_m).x();
  }
  return s_m;
}

GaugeClearance OwnTrack::ClearanceAhead(const Transform& world_from_vehicle,
                                        const Transform& world_from_box,
                                        const Vector3& size_m) const {
  const double vehicle_s_m = ChainageNear_m(world_from_vehicle.translation());
  const bool is_along = track_.WorldFromTrack(alignment_, vehicle_s_m)
                            .linear()
                            .col(0)
                            .dot(world_from_vehicle.linear().col(0)) > 0.0;
  GaugeClearance nearest{.is_inside = false,
                         .from_axis_m = std::numeric_limits<double>::infinity()};
  const double box_s_m = ChainageNear_m(world_from_box.translation());
  // The height is not cut, since the vertical curvature of a track is small.
  const int num_x = PiecesOf(size_m.x());
  const int num_y = PiecesOf(size_m.y());
  const Vector3 piece_m(size_m.x() / num_x, size_m.y() / num_y, size_m.z());
  for (int i = 0; i < num_x * num_y; ++i) {
    const Vector3 center_m(piece_m.x() * (i % num_x + 0.5) - 0.5 * size_m.x(),
                           piece_m.y() * (i / num_x + 0.5) - 0.5 * size_m.y(), 0.0);
    Transform world_from_piece = world_from_box;
    world_from_piece.translate(center_m);
    const double s_m = Refined_m(box_s_m, world_from_piece.translation());
    const bool is_ahead = is_along ? s_m > vehicle_s_m : s_m < vehicle_s_m;
    if (!is_ahead || s_m < track_.begin_s_m() || s_m > track_.end_s_m()) continue;
    const GaugeClearance piece = ClearanceOf(
        gauge_, track_.WorldFromTrack(alignment_, s_m).inverse() * world_from_piece, piece_m);
    nearest.is_inside = nearest.is_inside || piece.is_inside;
    nearest.from_axis_m = std::min(nearest.from_axis_m, piece.from_axis_m);
  }
  return nearest;
}

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
  const OwnTrack own_track(*info.scenario);
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
