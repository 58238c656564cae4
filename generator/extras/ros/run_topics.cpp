#include "generator/extras/ros/run_topics.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include "core/rail/line/track_course.h"
#include "core/rail/network/network.h"
#include "core/scan/spinning_pattern.h"
#include "core/simulate/returns.h"

namespace railcast {
namespace {

// The vendor's numbers of a spinning sensor's channels, by row.
std::vector<std::uint16_t> ChannelsByRow(const LidarSpec& lidar) {
  const auto* const spinning = std::get_if<SpinningSpec>(&lidar.scan.pattern);
  if (spinning == nullptr) return {};
  const std::vector<std::uint16_t> rows = RowsByElevation(spinning->channels);
  std::vector<std::uint16_t> channels(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) channels[rows[i]] = static_cast<std::uint16_t>(i);
  return channels;
}

// A line along a rail's running edge, left of the track's axis by `d_m`.
std::vector<Vector3> RailLine(const RailWorld& world, const TrackCourse& course, double d_m) {
  constexpr double kStep_m = 5.0;
  const double begin_s_m = std::max(course.begin_s_m(), 0.0);
  const double end_s_m = std::min(course.end_s_m(), world.alignment().length_m());
  std::vector<Vector3> line_m;
  const double num_steps = std::max(std::ceil((end_s_m - begin_s_m) / kStep_m), 1.0);
  for (double i = 0.0; i <= num_steps; ++i) {
    const double s_m = begin_s_m + (end_s_m - begin_s_m) * i / num_steps;
    line_m.push_back(course.WorldFromTrack(world.alignment(), s_m, d_m).translation());
  }
  return line_m;
}

std::vector<std::vector<Vector3>> RailLines(const RailWorld& world, double gauge_m) {
  std::vector<std::vector<Vector3>> lines_m;
  for (const TrackCourse& course : world.network().courses) {
    for (const double d_m : {gauge_m / 2.0, -gauge_m / 2.0}) {
      lines_m.push_back(RailLine(world, course, d_m));
    }
  }
  return lines_m;
}

std::vector<ros::SceneBox> BoxesOf(const std::vector<ObjectInFrame>& objects) {
  std::vector<ros::SceneBox> boxes;
  for (const ObjectInFrame& object : objects) {
    boxes.push_back({.name = object.name,
                     .label = object.label,
                     .instance = object.instance,
                     .size_m = object.size_m,
                     .world_from_box = object.world_from_box,
                     .velocity_world_mps = object.velocity_world_mps,
                     .points = object.points,
                     .occlusion = object.view.occlusion()});
  }
  return boxes;
}

}  // namespace

ros::TopicsSpec TopicsSpecOf(const ScenarioSpec& scenario,
                             const RailWorld& world,
                             const ros::CloudSpec& clouds,
                             ros::ImageEncoding images) {
  constexpr double kMmPerM = 1000.0;
  ros::TopicsSpec spec;
  for (const std::string& name : SensorNames(scenario)) {
    const ScenarioSpec reduced = PickSensor(scenario, name);
    if (spec.sensors.empty() && scenario.camera) {
      spec.camera = {*scenario.camera, VehicleFromCamera(reduced), images};
    }
    const LidarSpec& lidar = reduced.lidar;
    spec.sensors.push_back({name, VehicleFromSensor(lidar.mount),
                            NumReturns(lidar.receiver.return_mode), lidar.scan.rate_hz,
                            ChannelsByRow(lidar)});
  }
  spec.motion = scenario.motion_sensors.value_or(MotionSensorsSpec{});
  for (const ImuSpec& imu : spec.motion.imus) {
    spec.vehicle_from_imu.push_back(VehicleFromSensor(imu.mount));
  }
  spec.clouds = clouds;
  spec.output = scenario.output;
  spec.labels = LabelTable(scenario.labels);
  spec.rails_m = RailLines(world, scenario.world.alignment.gauge_mm / kMmPerM);
  return spec;
}

std::vector<ros::TopicMessage> MessagesOf(const ros::FrameTopics& topics,
                                          std::size_t sensor,
                                          const MadeFrame& made) {
  const std::vector<ros::SceneBox> boxes = BoxesOf(made.objects);
  return topics.Of({.sensor = sensor,
                    .frame = made.frame,
                    .vehicle = made.vehicle,
                    .boxes = boxes,
                    .image = made.has_image ? &made.image : nullptr,
                    .motion = &made.motion});
}

}  // namespace railcast
