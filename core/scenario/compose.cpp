#include <sstream>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/rail/rail_world.h"
#include "core/scan/scan_pattern.h"
#include "core/scenario/scenario.h"

namespace railcast {
namespace {

// Builds something from the spec that stands at `pointer` of the scenario, and lets its faults name
// the file that the spec was read from.
template <class Builder>
auto Located(const ScenarioSpec& spec, std::string_view pointer, const Builder& build) {
  try {
    return build();
  } catch (const InputError& error) {
    ErrorList located;
    std::istringstream lines(error.what());
    for (std::string line; std::getline(lines, line);) {
      located.Add(spec.sources.Locate(line, pointer));
    }
    located.ThrowIfAny();
    throw;
  }
}

ScanPattern MakePattern(const ScenarioSpec& spec) {
  return Located(spec, "/lidar/scan", [&] { return BuildScanPattern(spec.lidar.scan); });
}

Transform VehicleFromSensor(const MountSpec& mount) {
  return MakeTransform(
      RotationFromYawPitchRoll(RadFromDeg(mount.yaw_deg), RadFromDeg(mount.pitch_deg),
                               RadFromDeg(mount.roll_deg)),
      {mount.position_m[0], mount.position_m[1], mount.position_m[2]});
}

}  // namespace

std::shared_ptr<const RailWorld> MakeWorld(const ScenarioSpec& spec) {
  // The world has two specs, so its pointers are the scenario's: "/world/..." and "/vehicle/...".
  return Located(spec, "", [&] {
    return std::make_shared<const RailWorld>(spec.world, spec.vehicle, LabelTable(spec.labels),
                                             MaterialLibrary(spec.materials), spec.world.seed);
  });
}

std::unique_ptr<Simulator> MakeSimulator(const ScenarioSpec& spec,
                                         int num_threads,
                                         const std::string& isa) {
  SimulatorSpec simulator;
  simulator.seed = spec.seed;
  simulator.range_min_m = spec.lidar.range_min_m;
  simulator.range_max_m = spec.lidar.range_max_m;
  simulator.vehicle_from_sensor = VehicleFromSensor(spec.lidar.mount);
  simulator.effects = EffectsOf(spec);
  simulator.plausibility = spec.lidar.plausibility;
  simulator.weather = spec.weather;
  simulator.output = spec.output;
  simulator.isa = isa;
  simulator.snow_label = LabelTable(spec.labels).Id("snow");
  return std::make_unique<Simulator>(MakeWorld(spec), MakePattern(spec),
                                     MaterialLibrary(spec.materials), simulator, num_threads);
}

std::vector<std::string> CheckScenario(const std::filesystem::path& file) {
  std::vector<std::string> faults;
  const auto gather = [&](const auto& build) {
    try {
      build();
    } catch (const InputError& error) {
      std::istringstream lines(error.what());
      for (std::string line; std::getline(lines, line);) faults.push_back(line);
    }
  };
  gather([&] {
    const ScenarioSpec spec = ReadScenario(file);
    gather([&] { static_cast<void>(MakePattern(spec)); });
    gather([&] { static_cast<void>(MakeWorld(spec)); });
  });
  return faults;
}

}  // namespace railcast
