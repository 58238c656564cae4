#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "railcast/camera.h"
#include "railcast/effects.h"
#include "railcast/enum_names.h"
#include "railcast/error.h"
#include "railcast/frame.h"
#include "railcast/lidar.h"
#include "railcast/material.h"
#include "railcast/motion_sensors.h"
#include "railcast/rail_world.h"
#include "railcast/simulator.h"
#include "railcast/transform.h"

namespace railcast {

/// Records which file each value of a scenario came from, and its place there.
///
/// It maps pointers of the resolved scenario (`/lidar/scan/rate_hz`) to pointers of files, which
/// differ where a section has a file of its own (`sensors/vlp16.json: /scan/rate_hz`).
class ScenarioSources {
 public:
  /// Records that the values at and below `resolved_pointer` come from `file`, at and below
  /// `pointer`.
  void Add(std::string resolved_pointer, std::string file, std::string pointer);
  /// Records that messages show the file `absolute` as `shown`, a relative name if the user gave
  /// one.
  void AddFile(std::string absolute, std::string shown);

  /// Moves the entries at and below `from` in the resolved scenario to `to`.
  void Rename(std::string_view from, const std::string& to);

  /// The place of a value as "file: /pointer", or only the pointer if the file is unknown.
  [[nodiscard]] std::string Place(std::string_view resolved_pointer) const;

  /// Names the place of a builder's fault as the user knows it. Builders give a place as a pointer
  /// relative to their spec, which stands at `resolved_pointer`, or as the absolute name of a file.
  [[nodiscard]] Fault Locate(const Fault& fault, std::string_view resolved_pointer) const;

  /// Always true: two scenarios with the same values are equal, whichever files they came from.
  bool operator==(const ScenarioSources&) const { return true; }

 private:
  struct Entry {
    std::string resolved_pointer;
    std::string file;
    std::string pointer;
  };
  struct File {
    std::string absolute;
    std::string shown;
  };
  std::vector<Entry> entries_;
  std::vector<File> files_;
};

/// Mount error of a sensor: its true pose relative to the nominal one, in the nominal sensor's
/// axes. Rays leave from the true pose. Points in vehicle or world axes and reported poses use the
/// nominal one, as on a vehicle that does not know the error.
struct MountErrorSpec {
  std::array<double, 3> position_m{};
  double yaw_deg = 0.0;
  double pitch_deg = 0.0;
  double roll_deg = 0.0;

  bool operator==(const MountErrorSpec&) const = default;
};

/// Section `lidar` (the published Lidar.json).
struct LidarSpec {
  std::string name;
  ScanSpec scan;
  double range_min_m = 0.5;
  double range_max_m = 300.0;
  MountSpec mount;
  PlausibilitySpec plausibility;
  BeamSpec beam{};
  ReceiverSpec receiver{};
  CoverSpec cover{};
  std::optional<VelocitySpec> velocity{};
  MountErrorSpec mount_error{};
  /// File of an Ouster sensor's metadata, if `scan` is made from it.
  std::optional<std::string> ouster_metadata{};

  bool operator==(const LidarSpec&) const = default;
};

/// Section `tolerance`: by how much fidelity `auto` may differ from the reference rung.
struct ToleranceSpec {
  double range_m = 0.01;           ///< Median range error of matched echoes, before range noise.
  double missed_share = 0.1;       ///< Share of the reference's echoes that are missing.
  double false_share = 0.1;        ///< Share of the echoes that the reference lacks.
  double thin_missed_share = 0.1;  ///< Share of the reference's echoes of wires that are missing.
  double intensity = 0.1;          ///< Median relative error of matched echoes.
  /// Classes, by the names of their labels, whose echoes are compared; empty = all echoes are.
  std::vector<std::string> of{};

  bool operator==(const ToleranceSpec&) const = default;
};

/// Packet format of live frames: the railcast protocol (docs/stream.md) or that of a sensor of
/// Velodyne's, Hesai's or Ouster's (docs/packets.md); or messages for ROS 2 instead (docs/ros2.md).
enum class Protocol {
  kRailcast,
  kVlp16,
  kVlp16Dual,
  kHdl32e,
  kVlp32c,
  kVls128,
  kHdl64e,
  kPandar64,
  kXt32,
  kQt128,
  kPandar128e4x,
  kPandar128e4xStandard,
  kPandar40p,
  kQt64,
  kXt16,
  kXt32m,
  kAt128,
  kOuster,
  kRos2,
};
template <>
inline constexpr auto kEnumNames<Protocol> =
    std::to_array<EnumName<Protocol>>({{Protocol::kRailcast, "railcast"},
                                       {Protocol::kVlp16, "vlp16"},
                                       {Protocol::kVlp16Dual, "vlp16-dual"},
                                       {Protocol::kHdl32e, "hdl32e"},
                                       {Protocol::kVlp32c, "vlp32c"},
                                       {Protocol::kVls128, "vls128"},
                                       {Protocol::kHdl64e, "hdl64e"},
                                       {Protocol::kPandar64, "pandar64"},
                                       {Protocol::kXt32, "xt32"},
                                       {Protocol::kQt128, "qt128"},
                                       {Protocol::kPandar128e4x, "pandar128e4x"},
                                       {Protocol::kPandar128e4xStandard, "pandar128e4x-standard"},
                                       {Protocol::kPandar40p, "pandar40p"},
                                       {Protocol::kQt64, "qt64"},
                                       {Protocol::kXt16, "xt16"},
                                       {Protocol::kXt32m, "xt32m"},
                                       {Protocol::kAt128, "at128"},
                                       {Protocol::kOuster, "ouster"},
                                       {Protocol::kRos2, "ros2"}});

/// Where the live frames of one of several sensors are sent, and how they are packed.
struct SensorInterface {
  std::string sensor;  ///< Name of the sensor.
  Protocol protocol = Protocol::kRailcast;
  std::vector<std::string> udp;  ///< host:port of each receiver; see ReceiversOf().

  bool operator==(const SensorInterface&) const = default;
};

/// The size of the socket buffers of all subscribers in ROS 2: Linux's default of 208 KiB, or 1 MiB
/// or more, enough for a whole frame.
enum class ReceiveBuffers { kUsual, kLarge };
template <>
inline constexpr auto kEnumNames<ReceiveBuffers> = std::to_array<EnumName<ReceiveBuffers>>(
    {{ReceiveBuffers::kUsual, "usual"}, {ReceiveBuffers::kLarge, "large"}});

/// Key `interfaces.ros2`: how the sensors of Protocol::kRos2 reach ROS 2.
struct Ros2Spec {
  std::optional<std::uint32_t> domain;  ///< Absent: as ROS_DOMAIN_ID says, or 0.
  std::string interface;                ///< Name or address; empty = loopback.
  ReceiveBuffers receive_buffers = ReceiveBuffers::kUsual;
  double deceleration_mps2 = 0.5;  ///< The vehicle's; ROS 2's commands name only a speed.

  bool operator==(const Ros2Spec&) const = default;
};

/// Section `interfaces` (the published Interfaces.json): where live frames are sent.
struct InterfacesSpec {
  std::vector<std::string> udp;             ///< For a single sensor, as SensorInterface::udp.
  Protocol protocol = Protocol::kRailcast;  ///< For a single sensor.
  std::vector<SensorInterface> sensors;     ///< For several sensors: empty, or one entry for each.
  std::optional<Ros2Spec> ros2{};

  bool operator==(const InterfacesSpec&) const = default;
};

/// A complete scenario: everything a run depends on besides the frame index.
struct ScenarioSpec {
  std::uint64_t seed = 1;
  Fidelity fidelity = Fidelity::kPlausibility;
  ToleranceSpec tolerance;              ///< For fidelity `auto`.
  std::map<std::string, bool> effects;  ///< Switches individual effects on or off.
  LidarSpec lidar;                      ///< The sensor, if there is only one.
  std::vector<LidarSpec> lidars;        ///< The sensors, if there are several, each with a name.
  WeatherSpec weather;
  InterfacesSpec interfaces;
  std::optional<CameraSpec> camera;
  WorldSpec world;
  VehicleSpec vehicle;
  OutputSpec output;
  std::vector<Material> materials;  ///< From the material library that the scenario names.
  std::vector<Label> labels;        ///< From the label table that the scenario names.
  std::vector<ModelSpec> models;    ///< From the scenario's own table of models, if it has one.
  std::optional<MotionSensorsSpec> motion_sensors{};
  ScenarioSources sources;  ///< Where all these values were written.

  bool operator==(const ScenarioSpec&) const = default;
};

class RailWorld;

/// The UDP port on which receivers of a protocol listen by default.
[[nodiscard]] std::uint16_t DefaultPort(Protocol protocol);
/// The receivers of an interface as host:port; if it names none, the loopback address with the
/// protocol's default port.
[[nodiscard]] std::vector<std::string> ReceiversOf(const SensorInterface& interface);

/// Reads a scenario file and every file it names, strictly: unknown, duplicate, missing and
/// mistyped keys are errors. File names in the result are absolute.
///
///   const ScenarioSpec spec = ReadScenario("scenarios/open_line.json");
///   const std::unique_ptr<Simulator> simulator = MakeSimulator(spec, 0);
///
/// @throws InputError with a line for every fault: "file: /pointer: rule (got value)". If there is
///   a fault, the sound parts are built on trial, so that the message also lists the faults that
///   only building reveals; faults that merely follow from another one are left out.
[[nodiscard]] ScenarioSpec ReadScenario(const std::filesystem::path& file);

/// As ReadScenario(), but `text` is the content of `file`, which need not exist: names of other
/// files are relative to its folder, and messages show its name.
/// @throws InputError with the lines that ReadScenario() would give for a file of that content.
[[nodiscard]] ScenarioSpec ReadScenarioText(const std::string& text,
                                            const std::filesystem::path& file);

/// One of the four shapes, or a model that railcast ships (scenarios/models/models.json).
///
///     ObjectSpec wagon{.name = "wagon", .type = TypeNamed("open_wagon")};
///
/// @throws InputError if there is none of that name.
[[nodiscard]] ObjectType TypeNamed(std::string_view name);

/// Reads a label table (labels.json of a scenario or of a sequence) as strictly as ReadScenario().
/// @throws InputError with a line for every fault.
[[nodiscard]] LabelTable ReadLabelTable(const std::filesystem::path& file);

/// The scenario as JSON with every default written out and every named file's content in place.
/// Reading it back gives the same spec.
[[nodiscard]] std::string ResolvedScenarioJson(const ScenarioSpec& spec);

/// The transform from the sensor frame to the vehicle frame of a mount.
[[nodiscard]] Transform VehicleFromSensor(const MountSpec& mount);
/// The transform from the true sensor frame to the nominal one, which the mount gives.
[[nodiscard]] Transform NominalFromTrue(const MountErrorSpec& error);

/// The transform from the camera's optical axes (x right, y down, z forward) to the vehicle frame.
/// A camera without a mount of its own is in the place of the scenario's sensor.
/// @pre The scenario has a camera, and one sensor (PickSensor()).
[[nodiscard]] Transform VehicleFromCamera(const ScenarioSpec& spec);

/// Number of frames of the sensor per image of the camera: frame k has an image if this divides k.
/// @pre The scenario has a camera, and one sensor (PickSensor()).
[[nodiscard]] std::uint32_t FramesPerImage(const ScenarioSpec& spec);

/// Makes the scenario's camera; absent if it has none.
/// @pre The scenario has one sensor (PickSensor()).
[[nodiscard]] std::optional<Camera> MakeCamera(const ScenarioSpec& spec);

/// Makes the scenario's motion sensors; absent if it has none.
/// @param world The scenario's world, as it is at time 0.
[[nodiscard]] std::optional<MotionSensors> MakeMotionSensors(const ScenarioSpec& spec,
                                                             const RailWorld& world);

/// The effects of the scenario's rung with its switches applied, without a check for conflicts. For
/// fidelity `auto` these are the effects to choose from. Switches of unknown effects are ignored.
[[nodiscard]] EffectSet SwitchedEffects(const ScenarioSpec& spec);

/// As SwitchedEffects(), but checked for conflicts.
/// @throws InputError if two of the effects conflict, which can happen if the rung was changed
///   after the scenario was read.
[[nodiscard]] EffectSet EffectsOf(const ScenarioSpec& spec);

/// Whether anything that the scenario names has a material with `height_rms_um`.
[[nodiscard]] bool HasMirrors(const ScenarioSpec& spec);

/// The key of a sensor's own draws: the scenario's seed for a sensor without a name, else Philox's
/// words for that seed and the name's hash (FNV-1a, 64 bits). It depends on nothing else, so that a
/// sensor draws the same alone and beside others, and sensors of different names independently.
[[nodiscard]] std::uint64_t SensorSeed(std::uint64_t seed, const std::string& sensor_name);

/// The detector spec of one of the scenario's sensors. The labels of clutter are not set yet: they
/// are looked up when a simulator is made.
[[nodiscard]] DetectorSpec DetectorSpecOf(const ScenarioSpec& spec,
                                          const LidarSpec& lidar,
                                          const EffectSet& effects);

/// The names of the scenario's sensors, in their order. The name of a single sensor may be empty.
[[nodiscard]] std::vector<std::string> SensorNames(const ScenarioSpec& spec);

/// The scenario reduced to one of its sensors, which becomes `lidar`, and to that sensor's
/// interface.
/// @param name May be omitted if there is only one sensor.
/// @throws InputError if there is no such sensor:
///   "sensor: must be one of "front", "roof" (got "side")".
[[nodiscard]] ScenarioSpec PickSensor(const ScenarioSpec& spec,
                                      const std::optional<std::string>& name);

/// Sets the weather in `spec`, the spec of a simulator of the scenario, for Simulator::Use().
/// @throws InputError if the weather needs a label or a material that the scenario lacks.
void UseWeather(const ScenarioSpec& scenario, const WeatherSpec& weather, SimulatorSpec& spec);

/// Lists every fault of a scenario: the faults of its files and those that only building its scan
/// pattern and its world reveals. Empty if the scenario can run.
[[nodiscard]] std::vector<std::string> CheckScenario(const std::filesystem::path& file);

/// Builds the world of a scenario.
/// @throws InputError with the faults that CheckScenario() lists.
[[nodiscard]] std::shared_ptr<const RailWorld> MakeWorld(const ScenarioSpec& spec);

/// Builds the whole simulation of a scenario.
/// @param num_threads 0 = all cores.
/// @param isa Embree instruction set to force ("sse4.2", "avx2", "avx512"); empty = the best
///   available.
/// @throws InputError with the faults that CheckScenario() lists.
[[nodiscard]] std::unique_ptr<Simulator> MakeSimulator(const ScenarioSpec& spec,
                                                       int num_threads,
                                                       const std::string& isa = {});

/// Builds the simulations of all sensors of a scenario, in their order. They share one world and
/// one scene.
/// @throws InputError with the faults that CheckScenario() lists.
[[nodiscard]] std::vector<std::unique_ptr<Simulator>> MakeSimulators(const ScenarioSpec& spec,
                                                                     int num_threads,
                                                                     const std::string& isa = {});

}  // namespace railcast
