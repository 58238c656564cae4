#include <algorithm>
#include <memory>
#include <string>

#include "analysis/commands.h"
#include "analysis/detect_options.h"
#include "analysis/detectability/detect_report.h"
#include "analysis/report/output.h"
#include "analysis/report/provenance.h"
#include "core/base/join.h"
#include "core/io/run/scenario_identity.h"
#include "core/program/progress_line.h"
#include "core/program/version.h"
#include "railcast/io/recording.h"

namespace railcast {
namespace {

struct DetectOptions {
  std::vector<std::filesystem::path> sources;
  RuleOptions rule;
  ReportOutput output;
};

// The runs must be of one scenario, each with its own seed: otherwise their differences would not
// be due to chance alone.
void CheckSameScenario(const std::vector<RecordingInfo>& infos) {
  const RecordingInfo& last = infos.back();
  if (!last.scenario) return;  // FollowObjects() reports this.
  for (const RecordingInfo& other : infos) {
    if (&other == &last) return;
    ScenarioSpec same = WithFilesByContent(*other.scenario);
    if (same.seed == last.scenario->seed) {
      throw InputError(ShownPath(last.source) + ": /seed: must be another than that of " +
                       ShownPath(other.source) + " (got " + std::to_string(same.seed) + ")");
    }
    same.seed = last.scenario->seed;
    if (same != WithFilesByContent(*last.scenario)) {
      throw InputError(ShownPath(last.source) + ": must be of the same scenario as " +
                       ShownPath(other.source) + " but for its seed");
    }
  }
}

std::vector<std::pair<std::string, std::string>> FactsOf(const std::vector<RecordingInfo>& infos,
                                                         std::size_t num_frames) {
  const auto source_of = [](const RecordingInfo& info) { return ShownPath(info.source); };
  const auto seed_of = [](const RecordingInfo& info) { return NumberText(info.scenario->seed); };
  const ScenarioSpec& scenario = *infos.front().scenario;
  return {{"Sequences", Join(infos, ", ", source_of)},
          {"Seeds", Join(infos, ", ", seed_of)},
          {"Frames", std::to_string(num_frames)},
          {"Sensor", scenario.lidar.name}};
}

int RunDetect(const DetectOptions& options, const std::string& command_line) {
  CheckReportFolder(options.output.out, {"detect.json"});
  const DetectSpec spec = options.rule.Spec();
  std::vector<RecordingInfo> infos;
  std::vector<DetectRun> runs;
  std::size_t num_frames = 0;
  const ProgressLine progress;
  for (const std::filesystem::path& source : options.sources) {
    const auto recording = OpenRecording(source);
    infos.push_back(recording->info());
    CheckSameScenario(infos);
    const auto all = static_cast<double>(infos.back().num_frames.value_or(0));
    const auto num_sources = static_cast<double>(options.sources.size());
    RunCourses courses = FollowObjects(*recording, [&](std::size_t num) {
      const double run_share = std::min(1.0, static_cast<double>(num) / std::max(1.0, all));
      progress.Show("frames", (static_cast<double>(runs.size()) + run_share) / num_sources);
    });
    num_frames += courses.num_frames;
    runs.push_back(DetectInRun(source, infos.back().scenario->seed, std::move(courses), spec));
  }
  progress.End();
  std::ranges::sort(runs, {}, &DetectRun::seed);
  Report report =
      MakeDetectReport(runs, spec, command_line, FactsOf(infos, num_frames), RungOf(infos));
  if (!options.output.out.empty()) {
    Section pictures = MakePictureSection(runs);
    // Below the verdicts, which come first.
    if (!pictures.pictures.empty()) {
      report.sections.insert(report.sections.begin() + 1, std::move(pictures));
    }
  }
  AddProvenance(infos, ProgramVersion(), report);
  EmitReport(report, options.output, "detect");
  return kExitSuccess;
}

}  // namespace

void AddDetect(ProgramOptions& app, ProgramCommand& command) {
  const auto options = std::make_shared<DetectOptions>();
  ProgramOptions detect = app.AddCommand("detect",
                                         "Compare the distance at which objects in the way are "
                                         "detected with the distance that the train needs to stop");
  detect
      .AddOption("DIR", options->sources,
                 "Sequence directory; several of one scenario with different seeds give intervals")
      .Required()
      .Check(NonEmpty());
  detect
      .AddOption("--points", options->rule.spec.rule.min_points,
                 "Least number of points on an object that is seen in a frame")
      .Check(Whole({1, 1'000'000}))
      .ShowDefault();
  AddRuleOptions(detect, options->rule);
  AddReportOptions(detect, options->output);
  detect.WhenParsed([&command, options] {
    command = [options](const std::string& line) { return RunDetect(*options, line); };
  });
}

}  // namespace railcast
