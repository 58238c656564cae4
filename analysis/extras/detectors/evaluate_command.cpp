#include <algorithm>
#include <iostream>
#include <memory>
#include <optional>
#include <string>

#include "analysis/analysis_extras.h"
#include "analysis/commands.h"
#include "analysis/detect_options.h"
#include "analysis/extras/detectors/cluster_detector.h"
#include "analysis/extras/detectors/evaluate_report.h"
#include "analysis/extras/detectors/reported_detections.h"
#include "analysis/extras/detectors/run_evaluation.h"
#include "analysis/report/output.h"
#include "analysis/report/provenance.h"
#include "core/program/progress_line.h"
#include "core/program/version.h"
#include "railcast/io/recording.h"

namespace railcast {
namespace {

constexpr double kSecondsPerMs = 1e-3;

struct EvaluateOptions {
  std::vector<std::filesystem::path> sources;
  std::vector<std::filesystem::path> detections;  ///< For each source, or none.
  EvaluationSpec spec;
  RuleOptions rule;
  double latency_ms = 0.0;
  std::optional<double> gauge_width_m;
  std::optional<double> gauge_height_m;
  ReportOutput output;
};

void CheckIsEvaluated(const RecordingInfo& info) {
  if (info.scenario) return;
  throw InputError(ShownPath(info.source) +
                   ": must be a sequence directory, which says what was on the track (got " +
                   info.kind + ")");
}

/// What is evaluated of one run.
class RunUnderTest {
 public:
  RunUnderTest(const RecordingInfo& info, const EvaluateOptions& options, std::size_t index)
      : options_(options),
        points_{.output = info.scenario->output,
                .vehicle_from_sensor = VehicleFromSensor(info.scenario->lidar.mount)},
        reach_m_(info.scenario->lidar.range_max_m),
        track_(
            *MakeWorld(*info.scenario), info.scenario->world.catenary, PartsOf(options.spec.gauge)),
        evaluator_(track_, info.labels, points_.vehicle_from_sensor) {
    if (options.detections.empty()) return;
    reported_.emplace(ReadReportedRun(options.detections[index], points_.vehicle_from_sensor));
  }

  void Add(const RecordedFrame& recorded) {
    if (recorded.frame.duration_ns == 0) {
      throw InputError(recorded.name + ": a scan must take time to tell the sensor's speed");
    }
    FrameDetections found;
    found.latency_s = kSecondsPerMs * options_.latency_ms;
    if (!reported_) {
      found.boxes = FindClusters(recorded, points_.vehicle_from_sensor, track_,
                                 options_.spec.clusters, reach_m_);
    } else if (const ReportedFrame* const reported = reported_->Of(recorded.frame.index)) {
      found.latency_s = kSecondsPerMs * reported->latency_ms.value_or(options_.latency_ms);
      found.boxes = DetectionsOf(*reported, recorded, points_, track_, options_.spec.min_score);
    }
    evaluator_.Add(recorded, found);
  }

  [[nodiscard]] EvaluatedRun Finish(const std::filesystem::path& source, std::uint64_t seed) {
    if (reported_) reported_->CheckEnd();
    return evaluator_.Finish(source, seed, options_.spec.detect);
  }

 private:
  const EvaluateOptions& options_;
  PointsOfRun points_;
  double reach_m_;
  OwnTrack track_;
  RunEvaluator evaluator_;
  std::optional<ReportedFrames> reported_;
};

int RunEvaluate(EvaluateOptions options, const std::string& command_line) {
  CheckReportFolder(options.output.out, {"evaluate.json"});
  CheckDistinct(options.sources);
  if (!options.detections.empty() && options.detections.size() != options.sources.size()) {
    throw InputError("--detections: must be a file for each run, " +
                     NumberText(options.sources.size()) + Got(options.detections.size()));
  }
  options.spec.detect = options.rule.Spec();
  options.spec.has_files = !options.detections.empty();
  if (options.gauge_width_m) options.spec.gauge = {*options.gauge_width_m, *options.gauge_height_m};
  std::vector<RecordingInfo> infos;
  std::vector<EvaluatedRun> runs;
  const ProgressLine progress;
  for (std::size_t i = 0; i < options.sources.size(); ++i) {
    const auto recording = OpenRecording(options.sources[i]);
    CheckIsEvaluated(recording->info());
    infos.push_back(recording->info());
    RunUnderTest run(recording->info(), options, i);
    const auto all = static_cast<double>(infos.back().num_frames.value_or(1));
    for (std::size_t num = 1; const auto read = recording->Next(); ++num) {
      run.Add((*read)());
      const double run_share = std::min(1.0, static_cast<double>(num) / std::max(1.0, all));
      progress.Show("frames", (static_cast<double>(i) + run_share) /
                                  static_cast<double>(options.sources.size()));
    }
    runs.push_back(run.Finish(options.sources[i], infos.back().scenario->seed));
  }
  progress.End();
  Report report = MakeEvaluateReport(runs, infos, options.spec, command_line);
  AddProvenance(infos, ProgramVersion(), report);
  if (options.spec.has_files) {
    for (const std::string& warning : BoxWarnings(runs)) std::cerr << ShownLines(warning) + "\n";
  }
  EmitReport(report, options.output, "evaluate");
  return kExitSuccess;
}

void AddDetectorOptions(ProgramOptions& evaluate, EvaluateOptions& options) {
  const Option detections = evaluate.AddOption(
      "--detections", options.detections,
      "What your detector found in each run, in their order, instead of the reference detector: "
      "JSON lines or OpenLABEL (docs/evaluate.md)");
  evaluate
      .AddOption("--min-score", options.spec.min_score,
                 "Leave out detections of a file with a lower score")
      .Check(Number({0.0, 1.0}))
      .Needs(detections)
      .ShowDefault();
  evaluate
      .AddOption("--latency-ms", options.latency_ms,
                 "Time from a frame's stamp until its detections are known, if their file does "
                 "not state it")
      .Check(Number({0.0, 1e5}))
      .ShowDefault();
  ClusterDetectorSpec& clusters = options.spec.clusters;
  evaluate
      .AddOption("--min-height-m", clusters.min_height_m,
                 "Reference detector: leave out points lower above top of rail as track")
      .Check(Number({0.0, 5.0}))
      .Excludes(detections)
      .ShowDefault();
  evaluate
      .AddOption("--min-distance-m", clusters.min_distance_m,
                 "Reference detector: leave out points nearer ahead of the sensor as rain and "
                 "snow")
      .Check(Number({0.0, 100.0}))
      .Excludes(detections)
      .ShowDefault();
  evaluate
      .AddOption("--cluster-distance-m", clusters.cluster_distance_m,
                 "Reference detector: distance in plan up to which points are of one cluster")
      .Check(Number({0.01, 10.0}))
      .Excludes(detections)
      .ShowDefault();
  evaluate
      .AddOption("--cluster-points", clusters.min_points,
                 "Reference detector: least number of points of a cluster")
      .Check(Whole({1, 1'000'000}))
      .Excludes(detections)
      .ShowDefault();
}

void AddEvaluate(ProgramOptions& app, ProgramCommand& command) {
  const auto options = std::make_shared<EvaluateOptions>();
  ProgramOptions evaluate = app.AddCommand(
      "evaluate",
      "Evaluate an object detector, the reference one or yours: at which distances it detects what "
      "is in the way, and how many false alarms it gives per kilometre");
  evaluate.AddOption("RUN", options->sources, "Sequence directories, of any scenarios")
      .Required()
      .Check(NonEmpty());
  AddDetectorOptions(evaluate, *options);
  const Option width =
      evaluate
          .AddOption("--gauge-width-m", options->gauge_width_m,
                     "Width of the train's own gauge, instead of the vehicle's outline")
          .Check(Number({0.1, 10.0}));
  const Option height = evaluate
                            .AddOption("--gauge-height-m", options->gauge_height_m,
                                       "Height of the train's own gauge above top of rail")
                            .Check(Number({0.1, 10.0}))
                            .Needs(width);
  width.Needs(height);
  AddRuleOptions(evaluate, options->rule);
  AddReportOptions(evaluate, options->output);
  evaluate.WhenParsed([&command, options] {
    command = [options](const std::string& line) { return RunEvaluate(*options, line); };
  });
}

}  // namespace

void AddDetectors(AnalysisExtras& extras) {
  extras.commands["evaluate"] = AddEvaluate;
}

}  // namespace railcast
