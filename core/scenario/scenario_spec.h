#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/detect/detect_spec.h"
#include "core/frame/labels.h"
#include "core/frame/output_spec.h"
#include "core/rail/world_spec.h"
#include "core/scan/scan_spec.h"
#include "core/scenario/scenario_sources.h"
#include "core/scene/material.h"

namespace railcast {

/// Where the sensor sits on the vehicle.
struct MountSpec {
  std::array<double, 3> position_m{0.0, 0.0, 2.5};  ///< In the vehicle frame.
  double yaw_deg = 0.0;                             ///< Left positive.
  double pitch_deg = 0.0;                           ///< Nose down positive.
  double roll_deg = 0.0;

  bool operator==(const MountSpec&) const = default;
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

  bool operator==(const LidarSpec&) const = default;
};

/// Section `tolerance`: by how much fidelity `auto` may differ from the reference.
struct ToleranceSpec {
  double range_m = 0.01;           ///< Median error of matched echoes, before range noise.
  double missed_share = 0.1;       ///< Of the reference's echoes.
  double false_share = 0.1;        ///< Of the echoes: those that the reference lacks.
  double thin_missed_share = 0.1;  ///< Of the reference's echoes of wires.
  double intensity = 0.1;          ///< Median relative error of matched echoes.

  bool operator==(const ToleranceSpec&) const = default;
};

/// Where live frames of one of several sensors go, and how they are packed.
struct SensorInterface {
  std::string sensor;                 ///< Its name.
  std::string protocol = "railcast";  ///< One of ProtocolNames().
  std::vector<std::string> udp;       ///< host:port of each receiver; see ReceiversOf().

  bool operator==(const SensorInterface&) const = default;
};

/// Section `interfaces` (the published Interfaces.json): where live frames go.
struct InterfacesSpec {
  std::vector<std::string> udp;          ///< Of an only sensor, as SensorInterface::udp.
  std::string protocol = "railcast";     ///< Likewise.
  std::vector<SensorInterface> sensors;  ///< Of several sensors: empty, or one for each.

  bool operator==(const InterfacesSpec&) const = default;
};

/// A whole scenario: everything a run depends on besides the frame index.
struct ScenarioSpec {
  std::uint64_t seed = 1;
  std::string fidelity = "plausibility";  ///< One of FidelityNames().
  ToleranceSpec tolerance;                ///< Of fidelity `auto`.
  std::map<std::string, bool> effects;    ///< Switches single effects on or off.
  LidarSpec lidar;                        ///< The only sensor, ...
  std::vector<LidarSpec> lidars;          ///< ... or several, each with a name.
  WeatherSpec weather;
  InterfacesSpec interfaces;
  std::optional<std::string> camera;  ///< The camera section as read, kept for later.
  WorldSpec world;
  VehicleSpec vehicle;
  OutputSpec output;
  std::vector<Material> materials;  ///< Of the library the scenario names.
  std::vector<Label> labels;        ///< Of the label table the scenario names.
  ScenarioSources sources;          ///< Where all this was written.

  bool operator==(const ScenarioSpec&) const = default;
};

}  // namespace railcast
