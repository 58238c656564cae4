#include "core/scenario/sensors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <set>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/scenario/json_rules.h"
#include "railcast/scenario.h"

namespace railcast {
namespace {

double GreatestRate_hz(const MotionSensorsSpec& spec) {
  double greatest_hz = 0.0;
  const auto take = [&](const auto& sensors) {
    for (const auto& sensor : sensors) greatest_hz = std::max(greatest_hz, sensor.rate_hz);
  };
  take(spec.imus);
  take(spec.gnss);
  take(spec.odometers);
  return greatest_hz;
}

bool Contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// The interfaces of all sensors.
std::vector<SensorInterface> AllOf(const InterfacesSpec& interfaces) {
  if (!interfaces.sensors.empty()) return interfaces.sensors;
  return {{{}, interfaces.protocol, interfaces.udp}};
}

std::vector<std::string> FrameReceiversOf(const InterfacesSpec& interfaces) {
  std::vector<std::string> receivers;
  for (const SensorInterface& interface : AllOf(interfaces)) {
    for (std::string& to : ReceiversOf(interface)) receivers.push_back(std::move(to));
  }
  return receivers;
}

std::vector<std::string> PositionReceiversOf(const InterfacesSpec& interfaces) {
  std::vector<std::string> receivers;
  for (const SensorInterface& interface : AllOf(interfaces)) {
    const auto port = PositionPort(interface.protocol);
    if (!port) continue;
    for (const std::string& to : ReceiversOf(interface)) {
      receivers.push_back(to.substr(0, to.rfind(':') + 1) + std::to_string(*port));
    }
  }
  return receivers;
}

/// The rule that is broken by what is sent to `receivers` if one of them gets other datagrams, too.
std::string SharingFault(const std::vector<std::string>& receivers,
                         const char* sent,
                         const std::vector<std::string>& others,
                         const char* others_sent) {
  for (const std::string& receiver : receivers) {
    if (!Contains(others, receiver)) continue;
    return std::string("must send ") + sent + " elsewhere than to " + ShownText(receiver) +
           ", which gets " + others_sent;
  }
  return "";
}

/// The ports of a family of protocols.
struct ProtocolPorts {
  Protocol first{};  ///< First of the family, which ends where the next one begins.
  std::uint16_t data{};
  std::optional<std::uint16_t> position{};
};
constexpr std::array<ProtocolPorts, 4> kPorts = {
    {{Protocol::kRailcast, 27400, std::nullopt},
     {Protocol::kVlp16, kVelodyneDataPort, kVelodynePositionPort},
     // Position packets of Hesai's sensors repeat what a receiver of satellites said.
     {Protocol::kPandar64, kVelodyneDataPort, std::nullopt},
     {Protocol::kOuster, kOusterLidarPort, kOusterImuPort}}};

const ProtocolPorts& PortsOf(Protocol protocol) {
  const auto next = std::ranges::upper_bound(kPorts, protocol, {}, &ProtocolPorts::first);
  return *std::prev(next);
}

}  // namespace

std::uint16_t DefaultPort(Protocol protocol) {
  return PortsOf(protocol).data;
}

std::optional<std::uint16_t> PositionPort(Protocol protocol) {
  return PortsOf(protocol).position;
}

std::vector<std::string> ReceiversOf(const SensorInterface& interface) {
  if (!interface.udp.empty() || interface.protocol == Protocol::kRos2) return interface.udp;
  return {"127.0.0.1:" + std::to_string(DefaultPort(interface.protocol))};
}

std::vector<SensorPlace> SensorsOf(const ScenarioSpec& spec) {
  if (spec.lidars.empty()) return {{spec.lidar, "/lidar"}};
  std::vector<SensorPlace> sensors;
  for (const LidarSpec& lidar : spec.lidars) {
    sensors.push_back({lidar, "/lidars/" + std::to_string(sensors.size())});
  }
  return sensors;
}

std::vector<std::string> SensorNames(const ScenarioSpec& spec) {
  std::vector<std::string> names;
  for (const SensorPlace& sensor : SensorsOf(spec)) names.push_back(sensor.lidar.name);
  return names;
}

ScenarioSpec PickSensor(const ScenarioSpec& spec, const std::optional<std::string>& name) {
  const std::vector<std::string> names = SensorNames(spec);
  if (name && !Contains(names, *name)) {
    throw InputError("sensor: must be " + InWords(names) + " (got \"" + ShownText(*name) + "\")");
  }
  if (!name && names.size() > 1) {
    throw InputError("sensor: must be " + InWords(names) + " (got none of the scenario's sensors)");
  }
  if (spec.lidars.empty()) return spec;
  const auto index = static_cast<std::size_t>(
      name ? std::find(names.begin(), names.end(), *name) - names.begin() : 0);
  ScenarioSpec picked = spec;
  picked.lidar = spec.lidars[index];
  picked.lidars.clear();
  picked.sources.Rename("/lidars/" + std::to_string(index), "/lidar");
  for (const SensorInterface& interface : spec.interfaces.sensors) {
    if (interface.sensor != picked.lidar.name) continue;
    picked.interfaces.protocol = interface.protocol;
    picked.interfaces.udp = interface.udp;
  }
  picked.interfaces.sensors.clear();
  return picked;
}

std::string InterfacesFault(const InterfacesSpec& interfaces,
                            const std::vector<std::string>& sensors) {
  if (interfaces.sensors.empty()) return "";
  if (sensors.empty()) return "must be left out with \"lidar\", which has but one sensor";
  std::set<std::string> named;
  std::set<std::string> receivers;
  for (const SensorInterface& interface : interfaces.sensors) {
    if (!Contains(sensors, interface.sensor)) {
      return "must name sensors of the scenario, " + InWords(sensors) + ", not " +
             InWords({interface.sensor});
    }
    if (!named.insert(interface.sensor).second) {
      return "must name each sensor once, " + InWords({interface.sensor}) + " too";
    }
    const std::vector<std::string> own = ReceiversOf(interface);
    for (const std::string& receiver : own) {
      if (!receivers.contains(receiver)) continue;
      return "must give each sensor receivers of its own, " + InWords({interface.sensor}) +
             " others than " + ShownText(receiver);
    }
    receivers.insert(own.begin(), own.end());
  }
  for (const std::string& sensor : sensors) {
    if (!named.contains(sensor)) return "must name each sensor once, " + InWords({sensor}) + " too";
  }
  return "";
}

bool AreDifferent(const std::vector<std::string>& receivers) {
  return std::set<std::string>(receivers.begin(), receivers.end()).size() == receivers.size();
}

std::string PositionsFault(const InterfacesSpec& interfaces) {
  return SharingFault(FrameReceiversOf(interfaces), "frames", PositionReceiversOf(interfaces),
                      "position packets");
}

std::string ImagesFault(const CameraSpec& camera, const InterfacesSpec& interfaces) {
  std::string fault =
      SharingFault(camera.udp, "images", FrameReceiversOf(interfaces), "a sensor's frames");
  if (!fault.empty()) return fault;
  return SharingFault(camera.udp, "images", PositionReceiversOf(interfaces),
                      "a sensor's position packets");
}

std::optional<std::uint32_t> FramesFromImageToImage(const CameraSpec& camera, double scan_rate_hz) {
  if (!camera.rate_hz) return 1;
  // Rates are decimal fractions, whose quotient may be rounded.
  constexpr double kRounding = 1e-9;
  constexpr double kMostFrames = 1e6;
  const double num_frames = scan_rate_hz / *camera.rate_hz;
  const double whole = std::round(num_frames);
  if (!(whole >= 1.0 && whole <= kMostFrames && std::abs(num_frames / whole - 1.0) <= kRounding)) {
    return std::nullopt;
  }
  return static_cast<std::uint32_t>(whole);
}

bool HasFramesForImages(const ScenarioSpec& spec) {
  const std::vector<SensorPlace> sensors = SensorsOf(spec);
  return std::all_of(sensors.begin(), sensors.end(), [&](const SensorPlace& sensor) {
    return FramesFromImageToImage(*spec.camera, sensor.lidar.scan.rate_hz).has_value();
  });
}

std::uint32_t FramesPerImage(const ScenarioSpec& spec) {
  const auto num_frames = FramesFromImageToImage(*spec.camera, spec.lidar.scan.rate_hz);
  Check(num_frames.has_value(), "the scenario's reader checks the rates");
  return *num_frames;
}

Transform VehicleFromCamera(const ScenarioSpec& spec) {
  Eigen::Matrix3d body_from_optical;  // Body: x forward, y left, z up.
  body_from_optical << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return VehicleFromSensor(spec.camera->mount.value_or(spec.lidar.mount)) *
         MakeTransform(body_from_optical, Vector3::Zero());
}

std::optional<Camera> MakeCamera(const ScenarioSpec& spec) {
  if (!spec.camera) return std::nullopt;
  return Camera(*spec.camera, VehicleFromCamera(spec), MaterialLibrary(spec.materials));
}

bool HasFewSamplesInFrame(const MotionSensorsSpec& motion_sensors, const ScenarioSpec& spec) {
  const double greatest_hz = GreatestRate_hz(motion_sensors);
  return std::ranges::all_of(SensorsOf(spec), [&](const SensorPlace& sensor) {
    return greatest_hz <= kMostSamplesInFrame * sensor.lidar.scan.rate_hz;
  });
}

std::optional<MotionSensors> MakeMotionSensors(const ScenarioSpec& spec, const RailWorld& world) {
  if (!spec.motion_sensors) return std::nullopt;
  std::vector<Transform> vehicle_from_imus;
  for (const ImuSpec& imu : spec.motion_sensors->imus) {
    vehicle_from_imus.push_back(VehicleFromSensor(imu.mount));
  }
  return MotionSensors(*spec.motion_sensors, vehicle_from_imus, world, spec.world.alignment.map,
                       [&](const std::string& name) { return SensorSeed(spec.seed, name); });
}

}  // namespace railcast
