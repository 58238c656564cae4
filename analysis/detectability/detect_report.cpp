#include "analysis/detectability/detect_report.h"

#include <cmath>
#include <limits>
#include <utility>

#include "analysis/detectability/points_by_distance.h"
#include "analysis/detectability/verdict.h"
#include "core/base/attempt.h"
#include "core/base/number_text.h"
#include "core/base/shown_text.h"

namespace railcast {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kKmphPerMps = 3.6;
constexpr double kPermil = 1000.0;
/// More charts than this are a wall: the tables have the others.
constexpr std::size_t kMaxCharts = 12;

std::string RuleText(const DetectSpec& spec) {
  const DetectionRule& rule = spec.rule;
  return "An object is detected in the first frame in which it has had at least " +
         NumberText(rule.min_points) + " points in " + NumberText(rule.min_frames) +
         " of the last " + NumberText(rule.of_frames) +
         " frames, on the way to its closest point. Its distance is that of the sensor from the "
         "nearest point of its box.";
}

std::string BrakingText(const DetectSpec& spec) {
  const BrakingSpec& braking = spec.braking;
  return "Needed is s = v t + v^2 / (2 (a + g i)) + margin, with t = " +
         NumberText(braking.reaction_s) +
         " s from detection to full braking, a = " + NumberText(braking.deceleration_mps2) +
         " m/s^2 on the level, a margin of " + NumberText(braking.margin_m) +
         " m, and the gradient i where the object is detected. v is " +
         (spec.speed_mps ? "as given." : "the vehicle's own speed then.") +
         " What comes towards the vehicle needs its own way during the stop on top; what goes away "
         "is taken to stand.";
}

std::string RunsText(std::size_t num_runs) {
  if (num_runs == 1) {
    return "One run: no interval can be given, and another seed may end otherwise.";
  }
  if (num_runs < kMinSamples) {
    return NumberText(num_runs) + " runs with a seed each: fewer than " + NumberText(kMinSamples) +
           " give no interval.";
  }
  return NumberText(num_runs) +
         " runs with a seed each: intervals say what more seeds would change.";
}

Table VerdictTable(const std::vector<Verdict>& verdicts) {
  Table table;
  table.key = "verdicts";
  table.title = "Who is detected in time to stop";
  table.note =
      "Means over the runs that detected the object, but not at once; the share is of those that "
      "approached it and did not begin too near to tell.";
  table.columns = {{"object", "Object", ""},
                   {"type", "Type", ""},
                   {"verdict", "Verdict", ""},
                   {"runs", "Runs", ""},
                   {"detected_at_m", "Detected at", "m"},
                   {"needed_m", "Needed, at most", "m"},
                   {"spare_m", "To spare", "m"},
                   {"least_spare_m", "To spare, at least", "m"},
                   {"in_time", "In time", ""},
                   {"begun_too_near", "Begun too near to tell", ""}};
  for (const Verdict& verdict : verdicts) {
    table.rows.push_back(
        {verdict.name, verdict.type, verdict.InWords(), verdict.num_approached,
         verdict.distance_m.Mean(), verdict.most_needed_m, verdict.spare_m.Mean(),
         verdict.least_spare_m,
         Proportion(verdict.num_in_time, verdict.num_approached - verdict.num_undecided),
         verdict.num_undecided});
  }
  return table;
}

std::string FateText(const Detection& detection) {
  if (detection.fate == Fate::kNeverDetected) return "not detected";
  if (detection.fate == Fate::kNeverApproached) return "never approached";
  if (!detection.is_from_start) return detection.is_in_time() ? "in time" : "too late";
  return detection.is_in_time() ? "in time, at once" : "not known: begun too near";
}

Table RunTable(const std::vector<DetectRun>& runs) {
  Table table;
  table.key = "runs";
  table.title = "Each run";
  table.note =
      "At once, or begun too near: the run's first frames show the object, which may be seen from "
      "farther off.";
  table.columns = {{"seed", "Seed", ""},
                   {"object", "Object", ""},
                   {"outcome", "Outcome", ""},
                   {"detected_at_m", "Detected at", "m"},
                   {"speed_kmph", "Speed", "km/h"},
                   {"gradient_permil", "Gradient", "permil"},
                   {"braking_distance_m", "Braking distance", "m"},
                   {"needed_m", "Needed", "m"},
                   {"spare_m", "To spare", "m"}};
  for (const DetectRun& run : runs) {
    for (const auto& [name, detection] : run.detections) {
      const bool is_approached = detection.fate != Fate::kNeverApproached;
      const auto known = [&](double value) { return is_approached ? value : kNaN; };
      table.rows.push_back({run.seed, name, FateText(detection), detection.distance_m,
                            known(kKmphPerMps * detection.speed_mps),
                            known(kPermil * detection.gradient), known(detection.stop_m),
                            known(detection.needed_m), detection.spare_m()});
    }
  }
  return table;
}

void AddHeadlines(const std::vector<Verdict>& verdicts, Report& report) {
  std::uint64_t num_approached = 0;
  std::uint64_t num_in_time = 0;
  for (const Verdict& verdict : verdicts) {
    if (verdict.num_approached == 0) continue;
    ++num_approached;
    num_in_time += verdict.num_in_time == verdict.num_approached ? 1U : 0U;
  }
  report.headlines.push_back({"Objects approached", "", num_approached});
  report.headlines.push_back({"Always detected in time", "", num_in_time});
  const Verdict* worst = nullptr;
  for (const Verdict& verdict : verdicts) {
    if (std::isnan(verdict.least_spare_m)) continue;
    if (worst == nullptr || verdict.least_spare_m < worst->least_spare_m) worst = &verdict;
  }
  if (worst == nullptr) return;
  report.headlines.push_back(
      {"Least distance to spare, " + worst->name, "m", worst->least_spare_m});
}

}  // namespace

DetectRun DetectInRun(std::filesystem::path source,
                      std::uint64_t seed,
                      RunCourses courses,
                      const DetectSpec& spec) {
  DetectRun run{
      .source = std::move(source), .seed = seed, .courses = std::move(courses), .detections = {}};
  for (const auto& [name, course] : run.courses.objects) {
    const ObjectCourse& of_object = course;  // A lambda cannot hold a binding.
    run.detections[name] =
        AtPlace(ShownPath(run.source) + ": object " + ShownText(name) + ": ",
                [&] { return DetectObject(of_object, spec.rule, spec.braking, spec.speed_mps); });
  }
  return run;
}

Report MakeDetectReport(const std::vector<DetectRun>& runs,
                        const DetectSpec& spec,
                        const std::string& command,
                        std::vector<std::pair<std::string, std::string>> facts) {
  const std::vector<Verdict> verdicts = MakeVerdicts(runs);
  Report report;
  report.title = "Detection in time to stop";
  report.command = command;
  report.facts = std::move(facts);
  AddHeadlines(verdicts, report);

  Section verdict;
  verdict.key = "verdicts";
  verdict.title = "Verdicts";
  verdict.paragraphs = {RuleText(spec), BrakingText(spec), RunsText(runs.size())};
  verdict.tables = {VerdictTable(verdicts), RunTable(runs)};
  report.sections.push_back(std::move(verdict));

  Section points;
  points.key = "points";
  points.title = "Points against distance";
  for (const Verdict& object : verdicts) {
    if (object.num_approached == 0 || points.charts.size() == kMaxCharts) continue;
    points.charts.push_back(PointsChart(runs, object, spec.rule));
  }
  points.tables = {PointsTable(runs, spec.rule)};
  report.sections.push_back(std::move(points));
  return report;
}

}  // namespace railcast
