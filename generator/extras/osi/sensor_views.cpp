#include "generator/extras/osi/sensor_views.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <unordered_set>
#include <utility>
#include <vector>

#include "core/base/units.h"
#include "core/extras/osi/sensor_view.h"
#include "core/rail/motion/differentiated.h"
#include "core/rail/traffic/ego_train.h"

namespace railcast {
namespace {

// The power that the receiver gets of the emitted one at its detection threshold: that of a
// Lambertian surface of a known reflectance at a known range, at normal incidence, of which the
// window lets in aperture^2 / (4 range^2).
double PowerAtThreshold_ratio(const ScenarioSpec& scenario) {
  constexpr double kReflectanceOfDataSheets = 0.1;
  constexpr double kMmPerM = 1000.0;
  const bool is_published = SwitchedEffects(scenario).threshold;
  const LidarSpec& lidar = scenario.lidar;
  const double reflectance =
      is_published ? lidar.plausibility.reference_threshold : kReflectanceOfDataSheets;
  const double range_m =
      is_published ? lidar.plausibility.reference_range_m : lidar.receiver.range_at_10_percent_m;
  const double half_angle_rad = lidar.cover.aperture_mm / kMmPerM / (2.0 * range_m);
  return reflectance * half_angle_rad * half_angle_rad;
}

// From railcast's vehicle frame, which begins below the front pivot, to OSI's, which begins at the
// rear one.
Transform RearFromVehicle(const VehicleSpec& vehicle) {
  return Transform(Eigen::Translation3d(PivotDistance_m(vehicle), 0.0, 0.0));
}

osi::LidarOfView LidarOf(const FrameMaker& maker,
                         const ScenarioSpec& scenario,
                         std::size_t sensor) {
  // The sensor, the thing, and the mirror on both ways.
  constexpr std::uint32_t kWithMirror = 3;
  osi::LidarOfView lidar;
  lidar.sensor_id = sensor;
  lidar.detector_id = maker.num_sensors() + sensor;
  lidar.rear_from_sensor =
      RearFromVehicle(scenario.vehicle) * VehicleFromSensor(scenario.lidar.mount);
  lidar.pattern = &maker.pattern(sensor);
  lidar.firings = osi::FiringsByRay(*lidar.pattern);
  lidar.wavelength_nm = scenario.lidar.beam.wavelength_nm;
  lidar.max_interactions = SwitchedEffects(scenario).mirror_paths ? kWithMirror : 1;
  lidar.power_at_threshold_ratio = PowerAtThreshold_ratio(scenario);
  return lidar;
}

// The vehicle that carries the sensor. Without ego boxes and train its box has no size. OSI's boxes
// of vehicles begin on the ground.
osi::ObjectOfView HostOf(const RailWorld& world,
                         const VehicleSpec& vehicle,
                         const RigidMotion& motion) {
  osi::ObjectOfView host{.id = 0, .name = "ego", .type = "ego", .label = "ego", .moves = true};
  Eigen::AlignedBox3d box_m(Vector3::Zero());
  const auto& objects = world.objects();
  const auto own = std::ranges::find(objects, host.name, &SceneObject::name);
  if (own != objects.end()) {
    host.id = own->instance;
    box_m = own->model->Bounds();
    box_m.min().z() = std::min(box_m.min().z(), 0.0);
  }
  host.size_m = box_m.sizes();
  host.world_from_box = motion.world_from_body * Eigen::Translation3d(box_m.center());
  host.velocity_mps = motion.VelocityOf_mps(box_m.center());
  host.acceleration_mps2 = motion.AccelerationOf_mps2(box_m.center());
  host.front_m = -box_m.center();
  host.rear_m = Vector3(-PivotDistance_m(vehicle), 0.0, 0.0) - box_m.center();
  return host;
}

// The other vehicles of the sensor's train, which the survey leaves out.
void AddRestOfTrain(const RailWorld& world,
                    const Frame& frame,
                    std::vector<osi::ObjectOfView>& objects) {
  for (std::size_t i = 0; i < world.objects().size(); ++i) {
    const SceneObject& object = world.objects()[i];
    if (!object.is_ego || object.name == objects.front().name) continue;
    const Eigen::AlignedBox3d box_m = object.model->Bounds();
    const RigidMotion box = Differentiated([&](double after_s) -> Transform {
      const std::int64_t time_ns = frame.stamp_ns + std::llround(after_s * kNsPerS);
      return world.WorldFromObject(i, time_ns) * Eigen::Translation3d(box_m.center());
    });
    objects.push_back({.id = object.instance,
                       .name = object.name,
                       .type = object.type,
                       .label = "ego",
                       .moves = true,
                       .size_m = box_m.sizes(),
                       .world_from_box = box.world_from_body,
                       .velocity_mps = box.velocity_mps,
                       .acceleration_mps2 = box.acceleration_mps2});
  }
}

void AddSurveyed(const RailWorld& world,
                 const std::vector<ObjectInFrame>& surveyed,
                 std::vector<osi::ObjectOfView>& objects) {
  std::unordered_set<std::string_view> moving;
  for (const SceneObject& object : world.objects()) {
    if (object.moves) moving.insert(object.name);
  }
  for (const ObjectInFrame& object : surveyed) {
    objects.push_back({.id = object.instance,
                       .name = object.name,
                       .type = object.type,
                       .label = object.label,
                       .moves = moving.contains(object.name),
                       .size_m = object.size_m,
                       .world_from_box = object.world_from_box,
                       .velocity_mps = object.velocity_world_mps});
  }
}

}  // namespace

SensorViewMaker MakeSensorViews(const FrameMaker& maker,
                                const ScenarioSpec& scenario,
                                std::size_t sensor) {
  return [&maker, lidar = LidarOf(maker, scenario, sensor),
          vehicle = scenario.vehicle](const MadeFrame& made) {
    const FrameMaker::State& state = maker.StateAt(made.frame.stamp_ns);
    std::vector<osi::ObjectOfView> objects = {HostOf(*state.world, vehicle, made.vehicle)};
    AddRestOfTrain(*state.world, made.frame, objects);
    AddSurveyed(*state.world, made.objects, objects);
    const osi::FrameOfView view{made.frame, objects, state.weather};
    if (lidar.pattern->repeats()) return osi::SensorViewOf(lidar, view);
    const ScanPattern of_frame = PatternOfFrame(*lidar.pattern, made.frame.index);
    osi::LidarOfView in_frame = lidar;
    in_frame.pattern = &of_frame;
    in_frame.firings = osi::FiringsByRay(of_frame);
    return osi::SensorViewOf(in_frame, view);
  };
}

}  // namespace railcast
