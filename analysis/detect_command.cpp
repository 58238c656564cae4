#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "analysis/commands.h"
#include "analysis/detectability/detect_report.h"
#include "analysis/report/output.h"
#include "analysis/report/provenance.h"
#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/units.h"
#include "core/io/run/scenario_identity.h"
#include "core/program/progress_line.h"
#include "core/program/version.h"
#include "railcast/io/recording.h"

namespace railcast {
namespace {

struct DetectOptions {
  std::vector<std::filesystem::path> sources;
  DetectSpec spec;
  std::string frames = "3/5";
  std::optional<double> speed_kmph;
  ReportOutput output;
};

/// Reads "3/5" into the rule; returns false if the text is not of this form.
bool ReadFrames(std::string_view text, DetectionRule& rule) {
  const std::size_t slash = text.find('/');
  if (slash == std::string_view::npos) return false;
  const auto some = ParseNumber<std::uint32_t>(text.substr(0, slash));
  const auto all = ParseNumber<std::uint32_t>(text.substr(slash + 1));
  if (!some || !all || *some < 1 || *some > *all) return false;
  rule.min_frames = *some;
  rule.of_frames = *all;
  return true;
}

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
  std::string sources;
  std::string seeds;
  for (const RecordingInfo& info : infos) {
    if (!sources.empty()) sources += ", ";
    sources += ShownPath(info.source);
    if (!seeds.empty()) seeds += ", ";
    seeds += std::to_string(info.scenario->seed);
  }
  const ScenarioSpec& scenario = *infos.front().scenario;
  return {{"Sequences", sources},
          {"Seeds", seeds},
          {"Frames", std::to_string(num_frames)},
          {"Sensor", scenario.lidar.name}};
}

int RunDetect(const DetectOptions& options, const std::string& command_line) {
  DetectSpec spec = options.spec;
  if (options.speed_kmph) spec.speed_mps = MpsFromKmph(*options.speed_kmph);
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

void AddRuleOptions(CLI::App& detect, DetectOptions& options) {
  DetectionRule& rule = options.spec.rule;
  detect
      .add_option("--points", rule.min_points,
                  "Least number of points on an object that is seen in a frame")
      ->transform(Whole({1, 1'000'000}))
      ->capture_default_str();
  const auto check = [](const std::string& text) {
    DetectionRule trial;
    return ReadFrames(text, trial) ? std::string()
                                   : "must be K/N with 1 <= K <= N (got " + text + ")";
  };
  detect
      .add_option("--frames", options.frames,
                  "An object is detected when it is seen in K of N consecutive frames")
      ->check(CLI::Validator(check, "K/N"))
      ->capture_default_str();
}

void AddBrakingOptions(CLI::App& detect, DetectOptions& options) {
  BrakingSpec& braking = options.spec.braking;
  detect
      .add_option("--reaction-s", braking.reaction_s, "Seconds from the detection to full braking")
      ->check(Number({0.0, 60.0}))
      ->capture_default_str();
  detect
      .add_option(
          "--deceleration-mps2", braking.deceleration_mps2,
          "Braking deceleration on the level: 0.3 slow freight, 0.5 shunting, 1.0 multiple unit")
      ->check(Number({0.01, 10.0}))
      ->capture_default_str();
  detect
      .add_option("--speed-kmph", options.speed_kmph,
                  "Speed to brake from, instead of the vehicle's own at the detection")
      ->check(Number({0.0, 500.0}));
  detect.add_option("--margin-m", braking.margin_m, "Metres to be left before the object")
      ->check(Number({0.0, 1000.0}))
      ->capture_default_str();
}

}  // namespace

void AddDetect(CLI::App& app, ProgramCommand& command) {
  const auto options = std::make_shared<DetectOptions>();
  CLI::App* detect =
      app.add_subcommand("detect",
                         "Compare the distance at which objects in the way are detected "
                         "with the distance that the train needs to stop");
  detect
      ->add_option(
          "DIR", options->sources,
          "Sequence directory; several of one scenario with different seeds give intervals")
      ->required();
  AddRuleOptions(*detect, *options);
  AddBrakingOptions(*detect, *options);
  AddReportOptions(*detect, options->output);
  detect->callback([&command, options] {
    // CLI11 has checked the form already.
    (void)ReadFrames(options->frames, options->spec.rule);
    command = [options](const std::string& line) { return RunDetect(*options, line); };
  });
}

}  // namespace railcast
