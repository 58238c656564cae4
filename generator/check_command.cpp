#include <iostream>
#include <string>

#include "core/base/error.h"
#include "core/fidelity/choice_report.h"
#include "core/io/write_file.h"
#include "core/rail/rail_world.h"
#include "core/rail/world_check.h"
#include "core/scan/scan_pattern.h"
#include "core/scenario/effects.h"
#include "core/scenario/scenario.h"
#include "generator/check_report.h"
#include "generator/chosen_fidelity.h"
#include "generator/commands.h"
#include "generator/effects_report.h"

namespace railcast {
namespace {

void PrintReport(const ScenarioSpec& scenario, bool is_verbose) {
  const ScanPattern pattern = BuildScanPattern(scenario.lidar.scan);
  const auto world = MakeWorld(scenario);
  const MaterialLibrary materials(scenario.materials);
  const LabelTable labels(scenario.labels);
  const TrackSpec& track = *FindTrack(scenario.world, scenario.vehicle.track);
  const double range_m = scenario.lidar.range_max_m;
  const auto& mount_m = scenario.lidar.mount.position_m;
  const Surroundings around =
      LookAround(world, materials, {mount_m[0], mount_m[1], mount_m[2]}, range_m);
  const double length_m = world->alignment().length_m();

  std::cout << SensorText(scenario.lidar, pattern) << LineText(world->alignment(), is_verbose)
            << VehicleText(track.name, FindVehicleWay(scenario.vehicle, track, length_m),
                           pattern.rate_hz)
            << EffectsText(scenario) << OutputText(scenario.output, around.position_world)
            << SurroundingsText(around, *world, labels)
            << SceneText(AuditScene(*world, materials, pattern.StampNs(0), range_m))
            << ObjectsText(*world, labels);
  if (scenario.fidelity == kAutoFidelity) {
    const auto simulator = MakeSimulator(scenario, 0);
    std::cout << ChoiceText(UseChosenFidelity(*simulator, scenario), scenario.tolerance);
  }
  if (scenario.camera) std::cout << "camera    read and kept for later; nothing uses it yet\n";
}

}  // namespace

int CheckCommand(const CheckOptions& options) {
  ErrorList faults;
  for (const std::string& fault : CheckScenario(options.scenario)) faults.Add(fault);
  faults.ThrowIfAny();
  const ScenarioSpec scenario = ReadScenario(options.scenario);
  if (options.resolved == "-") {
    std::cout << ResolvedScenarioJson(scenario);
    return kExitSuccess;
  }
  if (options.resolved) WriteFileWhole(*options.resolved, ResolvedScenarioJson(scenario));
  PrintReport(scenario, options.is_verbose);
  if (options.resolved) std::cout << "resolved scenario in " << *options.resolved << "\n";
  return kExitSuccess;
}

}  // namespace railcast
