#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/certify/certifier.h"
#include "core/fidelity/choice_report.h"
#include "core/io/run/run_folder.h"
#include "core/io/write_file.h"
#include "core/scenario/track_limits.h"
#include "core/simulate/detail_choice.h"
#include "generator/check/check_report.h"
#include "generator/commands.h"
#include "generator/run/run_plan.h"
#include "generator/run/stopping.h"
#include "railcast/effects.h"
#include "railcast/lidar.h"
#include "railcast/rail_world.h"
#include "railcast/scenario.h"

namespace railcast {
namespace {

struct CheckOptions {
  std::filesystem::path scenario;
  std::optional<std::string> resolved;  ///< File for the resolved scenario; "-" = stdout.
  std::string certify = "off";
  bool is_verbose = false;
};

struct ReportChoices {
  bool is_verbose = false;
  std::optional<double> cost_share{};  ///< Share for a certificate; absent = none is asked for.
};

/// The report on a scenario with one sensor.
class Report {
 public:
  Report(const ScenarioSpec& scenario, std::shared_ptr<const RailWorld> world)
      : scenario_(scenario),
        world_(std::move(world)),
        pattern_(BuildScanPattern(scenario.lidar.scan)),
        materials_(scenario.materials) {}

  [[nodiscard]] std::string Sensor() const { return SensorText(scenario_.lidar, pattern_); }

  [[nodiscard]] std::string Line(bool is_verbose) const {
    const VehicleWay way = FindVehicleWay(scenario_.vehicle, world_->vehicle_course());
    return LineText(world_->alignment(), scenario_.world.alignment.gauge_mm, is_verbose) +
           NetworkText(*world_) +
           VehicleText(StartTrack(*world_, scenario_.vehicle), way, scenario_.lidar.scan) +
           RideText(scenario_.vehicle) +
           RouteText(*world_, FindLateralPeak(*world_, scenario_.vehicle, way));
  }

  [[nodiscard]] std::string WhatItSees() const {
    const double range_m = scenario_.lidar.range_max_m;
    const auto& mount_m = scenario_.lidar.mount.position_m;
    const SensorSurroundings around =
        LookAround(world_, materials_, {mount_m[0], mount_m[1], mount_m[2]}, range_m);
    const std::int64_t stamp_ns = pattern_.StampNs(0);
    const std::vector<BuiltChunk> chunks = BuildChunksInReach(*world_, stamp_ns, range_m);
    return EffectsText(scenario_) + OutputText(scenario_.output, around.position_world) +
           SurroundingsText(around, *world_, LabelTable(scenario_.labels)) +
           OwnHitsText(CountOwnHits(world_, materials_, pattern_,
                                    VehicleFromSensor(scenario_.lidar.mount) *
                                        NominalFromTrue(scenario_.lidar.mount_error),
                                    range_m)) +
           SceneText(AuditScene(*world_, materials_, stamp_ns, chunks)) +
           DetailText(AuditDetail(*world_, stamp_ns, chunks, Detail()),
                      LabelTable(scenario_.labels));
  }

  [[nodiscard]] std::string Certificate(double cost_share) const {
    const auto simulator = MakeSimulator(scenario_, 0);
    if (scenario_.fidelity == Fidelity::kAuto) {
      static_cast<void>(UseChosenFidelity(*simulator, scenario_));
    }
    return CertificateBudgetText(scenario_, cost_share, *simulator);
  }

  [[nodiscard]] std::string Choice() const {
    if (scenario_.fidelity != Fidelity::kAuto) return "";
    const auto simulator = MakeSimulator(scenario_, 0);
    return ChoiceText(UseChosenFidelity(*simulator, scenario_));
  }

 private:
  [[nodiscard]] DetailRule Detail() const {
    const LidarSpec& lidar = scenario_.lidar;
    const SimulatorSpec spec{
        .detector = DetectorSpecOf(scenario_, lidar, SwitchedEffects(scenario_)),
        .vehicle_from_sensor = VehicleFromSensor(lidar.mount),
        .has_full_detail = scenario_.world.detail == SceneDetail::kFull};
    return DetailOf(spec, pattern_);
  }

  const ScenarioSpec& scenario_;
  std::shared_ptr<const RailWorld> world_;
  ScanPattern pattern_;
  MaterialLibrary materials_;
};

/// The frames, of the first sensor, in which the check looks for contacts.
struct CheckedFrames {
  ScanPattern pattern;
  std::uint32_t last{};
};

// Ten minutes, or until something leaves its track, where a run would end.
CheckedFrames FramesToCheck(const ScenarioSpec& scenario, const RailWorld& world) {
  constexpr std::int64_t kCheckedTime_ns = 600'000'000'000;
  const ScenarioSpec picked = PickSensor(scenario, SensorNames(scenario).front());
  CheckedFrames frames{BuildScanPattern(picked.lidar.scan), 0};
  frames.last = LastFrameOnTracks(scenario, world, frames.pattern,
                                  LastFrameBefore(frames.pattern, kCheckedTime_ns));
  return frames;
}

void PrintReport(const ScenarioSpec& scenario,
                 const std::shared_ptr<const RailWorld>& world,
                 const CheckedFrames& frames,
                 const ReportChoices& choices_of_report) {
  const std::vector<std::string> sensors = SensorNames(scenario);
  std::string choices;
  std::string certificates;
  for (const std::string& sensor : sensors) {
    const ScenarioSpec picked = PickSensor(scenario, sensor);
    const Report report(picked, world);
    std::cout << ShownLines(report.Sensor());
    if (sensor == sensors.front())
      std::cout << ShownLines(report.Line(choices_of_report.is_verbose));
    std::cout << ShownLines(report.WhatItSees());
    if (sensors.size() > 1) choices += ReportLine("sensor", sensor);
    choices += report.Choice();
    if (choices_of_report.cost_share) {
      certificates += report.Certificate(*choices_of_report.cost_share);
    }
  }
  std::cout << ShownLines(ObjectsText(*world, LabelTable(scenario.labels)))
            << ShownLines(MeshesText(scenario.world.objects, LabelTable(scenario.labels),
                                     MaterialLibrary(scenario.materials)))
            << ShownLines(GaugeText(FindGaugeEntries(scenario.world, *world)))
            << ShownLines(ContactsText(FindContactRuns(*world, frames.pattern, frames.last), *world,
                                       frames.last));
  if (scenario.fidelity == Fidelity::kAuto) std::cout << ShownLines(choices);
  std::cout << ShownLines(certificates);
  if (scenario.camera) std::cout << ShownLines(CameraText(*scenario.camera));
  if (scenario.motion_sensors) {
    std::cout << ShownLines(MotionSensorsText(*scenario.motion_sensors));
  }
}

int RunCheck(const CheckOptions& options) {
  const auto cost_share = CertifiedShareOf(options.certify);
  if (cost_share && options.resolved == "-") {
    throw InputError("--certify: must be without --resolved -, which has no other output");
  }
  if (options.resolved && options.resolved != "-") {
    CheckOutputFiles({{"SCENARIO", options.scenario}}, {{"--resolved", *options.resolved}});
  }
  ErrorList faults;
  for (const std::string& fault : CheckScenario(options.scenario)) faults.AddLine(fault);
  faults.ThrowIfAny();
  const ScenarioSpec scenario = ReadScenario(options.scenario);
  const std::shared_ptr<const RailWorld> world = MakeWorld(scenario);
  const CheckedFrames frames = FramesToCheck(scenario, *world);
  CheckVehicleIsClear(scenario, *world, frames.pattern, 0, frames.last);
  if (options.resolved == "-") {
    std::cout << ResolvedScenarioJson(scenario);
    return kExitSuccess;
  }
  if (options.resolved) WriteNamedFile(*options.resolved, ResolvedScenarioJson(scenario));
  PrintReport(scenario, world, frames, {options.is_verbose, cost_share});
  if (options.resolved)
    std::cout << "resolved scenario in " << ShownPath(*options.resolved) << "\n";
  return kExitSuccess;
}

}  // namespace

void AddCheck(ProgramOptions& app, ProgramCommand& command) {
  const auto options = std::make_shared<CheckOptions>();
  ProgramOptions check = app.AddCommand("check",
                                        "Report every fault of a scenario or, if it has none, what "
                                        "its scene contains and what the sensor sees");
  check.AddOption("SCENARIO", options->scenario, "Scenario file").Required().Check(NonEmpty());
  check
      .AddOption("--resolved", options->resolved,
                 "File to write the scenario to, with all defaults and included files filled in; "
                 "- is stdout, which then gets no other output")
      .Check(NonEmpty());
  check
      .AddOption("--certify", options->certify,
                 "Share of the frames' time, such as 1%: also print how precise a certificate of "
                 "that share would be, and the numerical error of three frames")
      .ShowDefault();
  check.AddFlag("-v,--verbose", options->is_verbose, "Print details of each step");
  check.WhenParsed([&command, options] {
    command = [options](const std::string&) { return RunCheck(*options); };
  });
}

}  // namespace railcast
