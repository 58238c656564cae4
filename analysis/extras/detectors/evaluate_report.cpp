#include "analysis/extras/detectors/evaluate_report.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "analysis/detectability/detect_report.h"
#include "analysis/detectability/detection_probability.h"
#include "analysis/estimate/streams.h"
#include "analysis/extras/detectors/alarm_report.h"
#include "analysis/report/provenance.h"
#include "analysis/report/words.h"
#include "core/base/text.h"

namespace railcast {
namespace {

constexpr double kMsPerSecond = 1e3;
constexpr double kKmPerMetre = 1e-3;

std::vector<DetectRun> DetectRunsOf(const std::vector<EvaluatedRun>& runs) {
  std::vector<DetectRun> result;
  for (const EvaluatedRun& run : runs) result.push_back(run.run);
  return result;
}

Section InWaySection(const std::vector<Verdict>& verdicts) {
  const bool is_any = std::ranges::any_of(verdicts, &Verdict::is_in_way);
  Section section = SectionOf(kDetectorsWords, "verdicts", {{"is_any", is_any}});
  if (!is_any) return section;
  section.tables = {VerdictTable(verdicts), MeansTable(verdicts)};
  return section;
}

Table EvaluatedRunTable(const std::vector<EvaluatedRun>& runs,
                        const std::vector<RecordingInfo>& infos) {
  Table table = TableOf(kDetectorsWords, "runs");
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const EvaluatedRun& run = runs[i];
    const std::vector<Cell> head = {ShownPath(run.run.source),
                                    WeatherText(infos[i].scenario->weather), run.driven_m,
                                    std::uint64_t{run.alarms.size()}};
    const std::size_t num_before = table.rows.size();
    const auto add = [&](const std::vector<Cell>& rest) {
      std::ranges::copy(rest, std::back_inserter(table.rows.emplace_back(head)));
    };
    for (const auto& [name, detection] : run.run.detections) {
      if (!detection.is_in_way || detection.fate == Fate::kNeverApproached) continue;
      add({name, FateText(detection), detection.distance_m, detection.needed_m,
           detection.spare_m()});
    }
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    if (table.rows.size() == num_before) add({std::string(), std::string(), kNone, kNone, kNone});
  }
  return table;
}

Section BoxSection(const std::vector<EvaluatedRun>& runs, bool has_files) {
  Section section = SectionOf(kDetectorsWords, "boxes");
  if (has_files) section.paragraphs = BoxWarnings(runs);
  Table table = TableOf(kDetectorsWords, "boxes");
  for (const EvaluatedRun& run : runs) {
    table.rows.push_back(
        {ShownPath(run.run.source), run.boxes.read, run.boxes.in_gauge, run.boxes.matched});
  }
  section.tables = {std::move(table)};
  return section;
}

Section LatencySection(const std::vector<EvaluatedRun>& runs) {
  Section section = SectionOf(kDetectorsWords, "latency");
  Moments latency_ms;
  double most_ms = 0.0;
  for (const EvaluatedRun& run : runs) {
    for (const double latency_s : run.latencies_s) {
      latency_ms.Add(kMsPerSecond * latency_s);
      most_ms = std::max(most_ms, kMsPerSecond * latency_s);
    }
  }
  Table table = TableOf(kDetectorsWords, "latency");
  table.rows = {{latency_ms.num(), latency_ms.PlainMean(), most_ms}};
  section.tables = {std::move(table)};
  return section;
}

std::string GaugeText(const std::optional<TrainGauge>& gauge) {
  if (!gauge) return "vehicle's outline on the own track";
  return NumberText(gauge->width_m) + " m wide, " + NumberText(gauge->height_m) +
         " m high over top of rail";
}

std::string DetectorText(const EvaluationSpec& spec) {
  if (!spec.has_files) return ClusterDetectorText(spec.clusters);
  std::string text = "as reported in files";
  if (spec.min_score > 0.0) text += ", scores from " + NumberText(spec.min_score);
  return text;
}

void AddEvaluateHeadlines(const std::vector<Verdict>& verdicts,
                          const std::vector<EvaluatedRun>& runs,
                          Report& report) {
  std::uint64_t num_judged = 0;
  std::uint64_t num_in_time = 0;
  for (const Verdict& verdict : verdicts) {
    if (!verdict.is_judged()) continue;
    ++num_judged;
    num_in_time += verdict.is_always_in_time() ? 1U : 0U;
  }
  std::uint64_t num_alarms = 0;
  for (const EvaluatedRun& run : runs) num_alarms += run.alarms.size();
  const double driven_m = SumDriven_m(runs);
  report.headlines = {{"In the way, and judged", "", num_judged},
                      {"Always detected in time", "", num_in_time},
                      {"Driven", "km", kKmPerMetre * driven_m},
                      {"False alarms per km", "1/km", AlarmsPerKm(num_alarms, driven_m)}};
  const auto beside = ObjectsBesideIn(runs);
  if (beside.empty()) return;
  std::uint64_t num_quiet = 0;
  for (const auto& [name, object] : beside) num_quiet += object.num_alarms == 0 ? 1U : 0U;
  report.headlines.push_back({"Must raise no alarm", "", std::uint64_t{beside.size()}});
  report.headlines.push_back({"Raise none", "", num_quiet});
}

}  // namespace

std::vector<std::string> BoxWarnings(const std::vector<EvaluatedRun>& runs) {
  std::vector<std::string> warnings;
  for (const EvaluatedRun& run : runs) {
    const BoxCounts& boxes = run.boxes;
    const bool has_any_in_way = std::ranges::any_of(
        run.run.detections, [](const auto& named) { return named.second.is_in_way; });
    const bool is_all_elsewhere = boxes.read > 0 && boxes.in_gauge == 0;
    if (!is_all_elsewhere && (!has_any_in_way || boxes.matched > 0)) continue;
    const std::string what =
        boxes.read == 0
            ? "no box was read"
            : (is_all_elsewhere
                   ? "of " + NumberText(boxes.read) + " boxes none reaches into the gauge"
                   : "of " + NumberText(boxes.in_gauge) +
                         " boxes in the gauge none is of an object") +
                  ": are they in the axes that their lines say?";
    warnings.push_back("WARNING: " + ShownPath(run.run.source) + ": " + what);
  }
  return warnings;
}

std::string ClusterDetectorText(const ClusterDetectorSpec& spec) {
  return "reference: points in the gauge from " + NumberText(spec.min_height_m) +
         " m over top of rail and " + NumberText(spec.min_distance_m) +
         " m ahead of the sensor on, in clusters of " + NumberText(spec.min_points) +
         " or more at distances up to " + NumberText(spec.cluster_distance_m) + " m";
}

Report MakeEvaluateReport(const std::vector<EvaluatedRun>& runs,
                          const std::vector<RecordingInfo>& infos,
                          const EvaluationSpec& spec,
                          const std::string& command) {
  const std::vector<DetectRun> detect_runs = DetectRunsOf(runs);
  const std::vector<Verdict> verdicts = MakeVerdicts(detect_runs);
  Report report{.title = "What a detector detects", .command = command};
  std::size_t num_frames = 0;
  for (const EvaluatedRun& run : runs) num_frames += run.frames.size();
  report.facts = {{"Runs", NumberText(runs.size())},
                  {"Frames", NumberText(num_frames)},
                  {"Detector", DetectorText(spec)},
                  {"Gauge", GaugeText(spec.gauge)},
                  {"Rule", NumberText(spec.detect.rule.min_frames) + " of " +
                               NumberText(spec.detect.rule.of_frames) + " frames"}};
  AddEvaluateHeadlines(verdicts, runs, report);
  report.sections = {InWaySection(verdicts), BoxSection(runs, spec.has_files),
                     AlarmSection(runs, spec.detect.rule)};
  const bool has_enough = std::ranges::any_of(verdicts, [](const Verdict& verdict) {
    return verdict.is_in_way && verdict.num_approached >= DetectionFit::kMinTargets;
  });
  if (has_enough) report.sections.push_back(MakeProbabilitySection(detect_runs, verdicts));
  report.sections.push_back(LatencySection(runs));
  Section section = SectionOf(kDetectorsWords, "runs");
  section.paragraphs = {BrakingText(spec.detect)};
  section.tables = {EvaluatedRunTable(runs, infos)};
  report.sections.push_back(std::move(section));
  return report;
}

}  // namespace railcast
