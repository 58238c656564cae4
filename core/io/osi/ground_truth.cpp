#include "core/io/osi/ground_truth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string_view>
#include <utility>

#include "core/base/units.h"
#include "core/detect/base/weather_optics.h"

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

}  // namespace

void Set(const Vector3& vector, osi3::Vector3d& message) {
  message.set_x(vector.x());
  message.set_y(vector.y());
  message.set_z(vector.z());
}

void Set(const Eigen::Matrix3d& rotation, osi3::Orientation3d& message) {
  message.set_yaw(std::atan2(rotation(1, 0), rotation(0, 0)));
  message.set_pitch(std::atan2(-rotation(2, 0), std::hypot(rotation(0, 0), rotation(1, 0))));
  message.set_roll(std::atan2(rotation(2, 1), rotation(2, 2)));
}

void SetVersion(osi3::InterfaceVersion& message) {
  message.set_version_major(3);
  message.set_version_minor(8);
  message.set_version_patch(0);
}

void SetTime(std::int64_t time_ns, osi3::Timestamp& message) {
  message.set_seconds(time_ns / kNsPerS);
  message.set_nanos(static_cast<std::uint32_t>(time_ns % kNsPerS));
}

void SetGroundTruth(const FrameOfView& view, osi3::GroundTruth& truth) {
  SetVersion(*truth.mutable_version());
  SetTime(view.frame.stamp_ns, *truth.mutable_timestamp());
  truth.mutable_host_vehicle_id()->set_value(view.objects.front().id);
  for (const ObjectOfView& object : view.objects) AddObject(object, truth);
  SetWeather(view.weather, *truth.mutable_environmental_conditions());
}

}  // namespace railcast::osi
