#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/shown_text.h"
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
#include "generator/report_line.h"

namespace railcast {
namespace {

/// What follows from a scenario with one sensor.
class Report {
 public:
  Report(const ScenarioSpec& scenario, std::shared_ptr<const RailWorld> world)
      : scenario_(scenario),
        world_(std::move(world)),
        pattern_(BuildScanPattern(scenario.lidar.scan)),
        materials_(scenario.materials) {}

  [[nodiscard]] std::string Sensor() const { return SensorText(scenario_.lidar, pattern_); }

  [[nodiscard]] std::string Line(bool is_verbose) const {
    const TrackSpec& track = *FindTrack(scenario_.world, scenario_.vehicle.track);
    const double length_m = world_->alignment().length_m();
    return LineText(world_->alignment(), is_verbose) +
           VehicleText(track.name, FindVehicleWay(scenario_.vehicle, track, length_m),
                       pattern_.rate_hz);
  }

  [[nodiscard]] std::string WhatItSees() const {
    const double range_m = scenario_.lidar.range_max_m;
    const auto& mount_m = scenario_.lidar.mount.position_m;
    const Surroundings around =
        LookAround(world_, materials_, {mount_m[0], mount_m[1], mount_m[2]}, range_m);
    return EffectsText(scenario_) + OutputText(scenario_.output, around.position_world) +
           SurroundingsText(around, *world_, LabelTable(scenario_.labels)) +
           SceneText(AuditScene(*world_, materials_, pattern_.StampNs(0), range_m));
  }

  [[nodiscard]] std::string Choice() const {
    if (scenario_.fidelity != kAutoFidelity) return "";
    const auto simulator = MakeSimulator(scenario_, 0);
    return ChoiceText(UseChosenFidelity(*simulator, scenario_), scenario_.tolerance);
  }

 private:
  const ScenarioSpec& scenario_;
  std::shared_ptr<const RailWorld> world_;
  ScanPattern pattern_;
  MaterialLibrary materials_;
};

void PrintReport(const ScenarioSpec& scenario, bool is_verbose) {
  const std::shared_ptr<const RailWorld> world = MakeWorld(scenario);
  const std::vector<std::string> sensors = SensorNames(scenario);
  std::string choices;
  for (const std::string& sensor : sensors) {
    const ScenarioSpec picked = PickSensor(scenario, sensor);
    const Report report(picked, world);
    std::cout << ShownLines(report.Sensor());
    if (sensor == sensors.front()) std::cout << ShownLines(report.Line(is_verbose));
    std::cout << ShownLines(report.WhatItSees());
    if (sensors.size() > 1) choices += ReportLine("sensor", sensor);
    choices += report.Choice();
  }
  constexpr std::int64_t kFrame0_ns = 0;
  std::cout << ShownLines(ObjectsText(*world, LabelTable(scenario.labels)))
            << ShownLines(OverlapsText(FindOverlaps(*world, kFrame0_ns), *world));
  if (scenario.fidelity == kAutoFidelity) std::cout << ShownLines(choices);
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
  if (options.resolved)
    std::cout << "resolved scenario in " << ShownPath(*options.resolved) << "\n";
  return kExitSuccess;
}

}  // namespace railcast
