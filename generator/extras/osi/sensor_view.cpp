#include "generator/extras/osi/sensor_view.h"

#include <google/protobuf/arena.h>
#include <google/protobuf/descriptor.pb.h>
#include <osi_sensor_view.pb.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string_view>
#include <unordered_set>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/units.h"
#include "core/detect/base/weather_optics.h"
#include "core/scan/firing.h"

namespace railcast::osi {
namespace {

using osi3::EnvironmentalConditions;
using osi3::MovingObject;
using osi3::StationaryObject;
using VehicleType = MovingObject::VehicleClassification;
using Classification = StationaryObject::Classification;

template <typename Value, std::size_t kSize>
using NamedValues = std::array<std::pair<std::string_view, Value>, kSize>;

template <typename Values>
const auto* FindValue(const Values& values, std::string_view name) {
  const auto found = std::ranges::find(values, name, &Values::value_type::first);
  return found == values.end() ? nullptr : &found->second;
}

/// What moves by itself, though it may stand, by its label.
constexpr NamedValues<MovingObject::Type, 6> kMovingTypes = {
    {{"person", MovingObject::TYPE_PEDESTRIAN},
     {"animal", MovingObject::TYPE_ANIMAL},
     {"road_vehicle", MovingObject::TYPE_VEHICLE},
     {"wagon", MovingObject::TYPE_VEHICLE},
     {"train", MovingObject::TYPE_VEHICLE},
     {"ego", MovingObject::TYPE_VEHICLE}}};

/// Road vehicles by their type.
constexpr NamedValues<VehicleType::Type, 6> kRoadVehicles = {
    {{"car", VehicleType::TYPE_CAR},
     {"lorry", VehicleType::TYPE_HEAVY_TRUCK},
     {"tractor", VehicleType::TYPE_WORK_MACHINE},
     {"bus", VehicleType::TYPE_BUS},
     {"bicycle", VehicleType::TYPE_BICYCLE},
     {"motorcycle", VehicleType::TYPE_MOTORCYCLE}}};

/// What stands, by its label.
constexpr NamedValues<Classification::Type, 13> kStationaryTypes = {
    {{"building", Classification::TYPE_BUILDING},
     {"pole", Classification::TYPE_POLE},
     {"mast", Classification::TYPE_POLE},
     {"signal", Classification::TYPE_POLE},
     {"tree", Classification::TYPE_TREE},
     {"bush", Classification::TYPE_VEGETATION},
     {"grass", Classification::TYPE_VEGETATION},
     {"fence", Classification::TYPE_BARRIER},
     {"buffer_stop", Classification::TYPE_BARRIER},
     {"derailer", Classification::TYPE_BARRIER},
     {"level_crossing", Classification::TYPE_BARRIER},
     {"noise_wall", Classification::TYPE_WALL},
     {"retaining_wall", Classification::TYPE_WALL}}};

VehicleType::Type VehicleTypeOf(const ObjectOfView& object) {
  if (object.label != "road_vehicle") return VehicleType::TYPE_TRAIN;
  const auto* const type = FindValue(kRoadVehicles, object.type);
  return type == nullptr ? VehicleType::TYPE_OTHER : *type;
}

/// A class and the least value that belongs to it.
template <typename Class>
struct ClassFrom {
  double least{};
  Class value{};
};

/// By mm/h.
constexpr auto kPrecipitations = std::to_array<ClassFrom<EnvironmentalConditions::Precipitation>>(
    {{149.0, EnvironmentalConditions::PRECIPITATION_EXTREME},
     {34.0, EnvironmentalConditions::PRECIPITATION_VERY_HEAVY},
     {8.1, EnvironmentalConditions::PRECIPITATION_HEAVY},
     {1.9, EnvironmentalConditions::PRECIPITATION_MODERATE},
     {0.5, EnvironmentalConditions::PRECIPITATION_LIGHT},
     {0.1, EnvironmentalConditions::PRECIPITATION_VERY_LIGHT},
     {0.0, EnvironmentalConditions::PRECIPITATION_NONE}});

/// By the visibility in metres.
constexpr auto kFogs = std::to_array<ClassFrom<EnvironmentalConditions::Fog>>(
    {{40'000.0, EnvironmentalConditions::FOG_EXCELLENT_VISIBILITY},
     {10'000.0, EnvironmentalConditions::FOG_GOOD_VISIBILITY},
     {4'000.0, EnvironmentalConditions::FOG_MODERATE_VISIBILITY},
     {2'000.0, EnvironmentalConditions::FOG_POOR_VISIBILITY},
     {1'000.0, EnvironmentalConditions::FOG_MIST},
     {200.0, EnvironmentalConditions::FOG_LIGHT},
     {50.0, EnvironmentalConditions::FOG_THICK},
     {0.0, EnvironmentalConditions::FOG_DENSE}});

template <typename Classes>
auto ClassOf(const Classes& classes, double value) {
  return std::ranges::find_if(classes, [&](const auto& one) { return value >= one.least; })->value;
}

// At which 5 % of the light are left, as OSI and the weather's visibility_m have it.
double Visibility_m(const WeatherSpec& weather) {
  const double extinction_per_m = FogExtinction_per_m(weather);
  return extinction_per_m > 0.0 ? std::log(20.0) / extinction_per_m
                                : std::numeric_limits<double>::infinity();
}

// OSI counts from the north, the weather from the east; both counterclockwise.
double FromNorth_rad(double from_east_deg) {
  constexpr double kTurn_deg = 360.0;
  const double from_north_deg = std::fmod(from_east_deg - 90.0, kTurn_deg);
  return RadFromDeg(from_north_deg < 0.0 ? from_north_deg + kTurn_deg : from_north_deg);
}

void SetWeather(const WeatherSpec& weather, EnvironmentalConditions& conditions) {
  constexpr double kLxPerKlx = 1000.0;
  conditions.set_precipitation(
      ClassOf(kPrecipitations, weather.rain_rate_mmph + weather.snow_rate_mmph));
  conditions.set_fog(ClassOf(kFogs, Visibility_m(weather)));
  conditions.mutable_wind()->set_origin_direction(FromNorth_rad(weather.wind_direction_deg));
  conditions.mutable_wind()->set_speed(weather.wind_speed_mps);
  if (weather.sun.illuminance_klx == 0.0) return;
  conditions.mutable_sun()->set_azimuth(FromNorth_rad(weather.sun.azimuth_deg));
  conditions.mutable_sun()->set_elevation(RadFromDeg(weather.sun.elevation_deg));
  conditions.mutable_sun()->set_intensity(kLxPerKlx * weather.sun.illuminance_klx);
}

void Set(const Vector3& vector, osi3::Vector3d& message) {
  message.set_x(vector.x());
  message.set_y(vector.y());
  message.set_z(vector.z());
}

/// As rotations about z, the new y and the new x axis.
void Set(const Eigen::Matrix3d& rotation, osi3::Orientation3d& message) {
  message.set_yaw(std::atan2(rotation(1, 0), rotation(0, 0)));
  message.set_pitch(std::atan2(-rotation(2, 0), std::hypot(rotation(0, 0), rotation(1, 0))));
  message.set_roll(std::atan2(rotation(2, 1), rotation(2, 2)));
}

template <typename Object>
void SetIdentityAndBox(const ObjectOfView& object, Object& message) {
  message.mutable_id()->set_value(object.id);
  osi3::ExternalReference& source = *message.add_source_reference();
  source.set_type("railcast");
  source.add_identifier(object.name);
  source.add_identifier(object.label);
  auto& base = *message.mutable_base();
  base.mutable_dimension()->set_length(object.size_m.x());
  base.mutable_dimension()->set_width(object.size_m.y());
  base.mutable_dimension()->set_height(object.size_m.z());
  Set(object.world_from_box.translation(), *base.mutable_position());
  Set(object.world_from_box.linear(), *base.mutable_orientation());
}

void SetMoving(const ObjectOfView& object, MovingObject::Type type, MovingObject& message) {
  SetIdentityAndBox(object, message);
  message.set_type(type);
  osi3::BaseMoving& base = *message.mutable_base();
  Set(object.velocity_mps, *base.mutable_velocity());
  if (object.acceleration_mps2) Set(*object.acceleration_mps2, *base.mutable_acceleration());
  // OSI demands the attributes of persons and vehicles, be they empty.
  if (type == MovingObject::TYPE_PEDESTRIAN) message.mutable_pedestrian_attributes();
  if (type != MovingObject::TYPE_VEHICLE) return;
  message.mutable_vehicle_classification()->set_type(VehicleTypeOf(object));
  auto& attributes = *message.mutable_vehicle_attributes();
  if (object.rear_m) Set(*object.rear_m, *attributes.mutable_bbcenter_to_rear());
  if (object.front_m) Set(*object.front_m, *attributes.mutable_bbcenter_to_front());
}

void AddObject(const ObjectOfView& object, osi3::GroundTruth& truth) {
  const MovingObject::Type* const moving = FindValue(kMovingTypes, object.label);
  if (moving != nullptr || object.moves) {
    const MovingObject::Type type = moving == nullptr ? MovingObject::TYPE_OTHER : *moving;
    return SetMoving(object, type, *truth.add_moving_object());
  }
  StationaryObject& message = *truth.add_stationary_object();
  SetIdentityAndBox(object, message);
  const auto* const type = FindValue(kStationaryTypes, object.label);
  message.mutable_classification()->set_type(type == nullptr ? Classification::TYPE_OTHER : *type);
}

/// OSI 3.8.0.
void SetVersion(osi3::InterfaceVersion& message) {
  message.set_version_major(3);
  message.set_version_minor(8);
  message.set_version_patch(0);
}

void SetTime(std::int64_t time_ns, osi3::Timestamp& message) {
  message.set_seconds(time_ns / kNsPerS);
  message.set_nanos(static_cast<std::uint32_t>(time_ns % kNsPerS));
}

/// Fills in objects and weather at the frame's stamp.
void SetGroundTruth(const FrameOfView& view, osi3::GroundTruth& truth) {
  SetVersion(*truth.mutable_version());
  SetTime(view.frame.stamp_ns, *truth.mutable_timestamp());
  truth.mutable_host_vehicle_id()->set_value(view.objects.front().id);
  for (const ObjectOfView& object : view.objects) AddObject(object, truth);
  SetWeather(view.weather, *truth.mutable_environmental_conditions());
}

constexpr double kNmPerM = 1e9;
/// As OSI says that there is no object.
constexpr std::uint64_t kNoObject = std::numeric_limits<std::uint64_t>::max();

void SetMount(const Transform& rear_from_sensor, osi3::MountingPosition& message) {
  Set(rear_from_sensor.translation(), *message.mutable_position());
  Set(rear_from_sensor.linear(), *message.mutable_orientation());
}

// OSI's fields of view lie to both sides of the x axis alike.
void SetFieldOfView(const ScanPattern& pattern, osi3::LidarSensorViewConfiguration& message) {
  double azimuth_rad = 0.0;
  double elevation_rad = 0.0;
  for (std::size_t i = 0; i < pattern.num_firings(); ++i) {
    const double x = pattern.direction_x[i];
    const double y = pattern.direction_y[i];
    const double z = pattern.direction_z[i];
    azimuth_rad = std::max(azimuth_rad, std::abs(std::atan2(y, x)));
    elevation_rad = std::max(elevation_rad, std::abs(std::atan2(z, std::hypot(x, y))));
  }
  message.set_field_of_view_horizontal(2.0 * azimuth_rad);
  message.set_field_of_view_vertical(2.0 * elevation_rad);
}

// Calls `visit(firing, slot)` for each ray.
template <typename Visit>
void ForEachRay(const LidarOfView& lidar, const Frame& frame, const Visit& visit) {
  for (const std::uint32_t firing : lidar.firings) {
    const std::size_t first = lidar.pattern->row[firing] * std::size_t{frame.width()} +
                              lidar.pattern->column[firing] * std::size_t{frame.returns};
    for (std::uint32_t i = 0; i < frame.returns; ++i) visit(firing, first + i);
  }
}

void SetRays(const LidarOfView& lidar,
             const Frame& frame,
             osi3::LidarSensorViewConfiguration& message) {
  const ScanPattern& pattern = *lidar.pattern;
  const auto num_rays = static_cast<int>(frame.num_slots());
  message.mutable_directions()->Reserve(num_rays);
  message.mutable_timings()->Reserve(num_rays);
  ForEachRay(lidar, frame, [&](std::uint32_t firing, std::size_t) {
    Set(BeamDirection(pattern, firing), *message.add_directions());
    message.add_timings(static_cast<std::uint32_t>(pattern.time_ns[firing] / kNsPerUs));
  });
}

void SetConfiguration(const LidarOfView& lidar,
                      const Frame& frame,
                      osi3::LidarSensorViewConfiguration& message) {
  message.mutable_sensor_id()->set_value(lidar.detector_id);
  SetMount(lidar.rear_from_sensor, *message.mutable_mounting_position());
  SetFieldOfView(*lidar.pattern, message);
  message.set_number_of_rays_horizontal(frame.width());
  message.set_number_of_rays_vertical(frame.rows);
  message.set_max_number_of_interactions(lidar.max_interactions);
  message.set_emitter_frequency(kSpeedOfLight_mps * kNmPerM / lidar.wavelength_nm);
  message.set_num_of_pixels(static_cast<std::uint32_t>(frame.num_slots()));
  SetRays(lidar, frame, message);
}

void SetReflection(const LidarOfView& lidar,
                   const Frame& frame,
                   std::size_t slot,
                   osi3::LidarSensorView::Reflection& message) {
  constexpr double kDbPerDecade = 10.0;
  message.set_time_of_flight(2.0 * static_cast<double>(frame.range_m[slot]) / kSpeedOfLight_mps);
  if (frame.has_velocity && !std::isnan(frame.radial_velocity_mps[slot])) {
    message.set_doppler_shift(-2.0 * static_cast<double>(frame.radial_velocity_mps[slot]) *
                              kNmPerM / lidar.wavelength_nm);
  }
  // Also false where no power is computed.
  if (frame.power_ratio[slot] > 0.0F) {
    message.set_signal_strength(
        kDbPerDecade *
        std::log10(static_cast<double>(frame.power_ratio[slot]) * lidar.power_at_threshold_ratio));
  }
}

void SetReflections(const LidarOfView& lidar,
                    const FrameOfView& view,
                    osi3::LidarSensorView& message) {
  std::unordered_set<std::uint64_t> known;
  for (const ObjectOfView& object : view.objects) known.insert(object.id);
  const Frame& frame = view.frame;
  message.mutable_reflection()->Reserve(static_cast<int>(frame.num_slots()));
  ForEachRay(lidar, frame, [&](std::uint32_t, std::size_t slot) {
    osi3::LidarSensorView::Reflection& reflection = *message.add_reflection();
    if (!HasPoint(frame.outcome[slot])) return;
    SetReflection(lidar, frame, slot, reflection);
    // The mirror image of an object is no reflection of it.
    const bool is_of_object = frame.outcome[slot] == Outcome::kReturned &&
                              frame.instance[slot] != 0 && known.contains(frame.instance[slot]);
    reflection.mutable_object_id()->set_value(is_of_object ? frame.instance[slot] : kNoObject);
  });
}

}  // namespace

std::string SensorViewOf(const LidarOfView& lidar, const FrameOfView& view) {
  Check(lidar.firings.size() * view.frame.returns == view.frame.num_slots(),
        "the frame is one of the lidar's");
  google::protobuf::Arena arena;
  auto& message = *google::protobuf::Arena::CreateMessage<osi3::SensorView>(&arena);
  SetVersion(*message.mutable_version());
  SetTime(view.frame.stamp_ns, *message.mutable_timestamp());
  message.mutable_sensor_id()->set_value(lidar.sensor_id);
  SetMount(lidar.rear_from_sensor, *message.mutable_mounting_position());
  SetGroundTruth(view, *message.mutable_global_ground_truth());
  message.mutable_host_vehicle_id()->set_value(view.objects.front().id);
  osi3::LidarSensorView& lidar_view = *message.add_lidar_sensor_view();
  SetConfiguration(lidar, view.frame, *lidar_view.mutable_view_configuration());
  SetReflections(lidar, view, lidar_view);
  const std::size_t size = message.ByteSizeLong();
  if (size > std::size_t{std::numeric_limits<std::int32_t>::max()}) {
    throw InputError("must be < 2^31 bytes as a message of OSI" + Got(size));
  }
  // The message has no maps, whose order alone may differ.
  return message.SerializeAsString();
}

std::string SensorViewDescriptors() {
  google::protobuf::FileDescriptorSet descriptors;
  osi3::SensorView::descriptor()->file()->CopyTo(descriptors.add_file());
  return descriptors.SerializeAsString();
}

std::string ProtobufVersion() {
  constexpr int kStep = 1000;
  return std::to_string(GOOGLE_PROTOBUF_VERSION / kStep / kStep) + "." +
         std::to_string(GOOGLE_PROTOBUF_VERSION / kStep % kStep) + "." +
         std::to_string(GOOGLE_PROTOBUF_VERSION % kStep);
}

}  // namespace railcast::osi
