#include <memory>
#include <optional>
#include <string>

#include "analysis/analysis_extras.h"
#include "analysis/commands.h"
#include "analysis/detect_options.h"
#include "analysis/extras/sight/sight.h"
#include "analysis/report/output.h"
#include "analysis/report/provenance.h"
#include "core/base/parallelism.h"
#include "core/base/units.h"
#include "core/io/run/scenario_identity.h"
#include "core/program/progress_line.h"
#include "core/program/version.h"
#include "railcast/scenario.h"

namespace railcast {
namespace {

struct SightOptions {
  std::filesystem::path scenario;
  std::optional<std::string> sensor;
  SightSpec spec;
  std::optional<double> speed_kmph;
  int num_threads = 0;
  ReportOutput output;
};

int RunSight(const SightOptions& options, const std::string& command_line) {
  CheckReportFolder(options.output.out, {"sight.json"});
  const auto limit = LimitThreads(options.num_threads);
  SightSpec spec = options.spec;
  if (options.speed_kmph) spec.speed_mps = MpsFromKmph(*options.speed_kmph);
  const ScenarioSpec scenario = PickSensor(ReadScenario(options.scenario), options.sensor);
  const ProgressLine progress;
  const std::vector<SightPlace> places =
      FollowSight(scenario, spec, [&](double done) { progress.Show("places on the way", done); });
  progress.End();
  Report report = MakeSightReport(places, spec, spec.range_m.value_or(scenario.lidar.range_max_m),
                                  command_line);
  report.facts = {{"Scenario", ShownPath(options.scenario)},
                  {"Scenario hash", IdentityOf(scenario).scenario_hash},
                  {"Sensor", scenario.lidar.name},
                  {"Places", NumberText(places.size())}};
  for (auto& fact : MakerFacts(ProgramVersion())) report.facts.push_back(std::move(fact));
  EmitReport(report, options.output, "sight");
  return kExitSuccess;
}

void AddSight(ProgramOptions& app, ProgramCommand& command) {
  const auto options = std::make_shared<SightOptions>();
  ProgramOptions sight = app.AddCommand(
      "sight",
      "Chart how far ahead along its track a vehicle sees, before curve, cutting, trees or tunnel "
      "hide it, beside the distance that it needs to stop");
  sight.AddOption("SCENARIO", options->scenario, "Scenario file").Required().Check(NonEmpty());
  sight
      .AddOption("--heights-m", options->spec.heights_m,
                 "Heights of the targets on the track, separated by commas")
      .SeparatedBy(',')
      .TakesOneWord()
      .Check(Number({0.05, 5.0}))
      .ShowDefault();
  sight
      .AddOption("--range-m", options->spec.range_m,
                 "How far targets are sought; otherwise as far as the sensor's range")
      .Check(Number({20.0, 5000.0}));
  sight.AddOption("--step-m", options->spec.step_m, "Least distance between consecutive places")
      .Check(Number({0.1, 1000.0}))
      .ShowDefault();
  AddBrakingOptions(sight, options->spec.braking);
  sight
      .AddOption("--speed-kmph", options->speed_kmph,
                 "Speed at which the vehicle runs from its start to the end of its route, instead "
                 "of its own")
      .Check(Number({0.0, 500.0}));
  sight.AddOption("--sensor", options->sensor,
                  "Name of the sensor, where the scenario has several");
  AddThreads(sight, options->num_threads);
  AddReportOptions(sight, options->output);
  sight.WhenParsed([&command, options] {
    command = [options](const std::string& line) { return RunSight(*options, line); };
  });
}

}  // namespace

void AddSight(AnalysisExtras& extras) {
  extras.commands["sight"] = AddSight;
}

}  // namespace railcast
