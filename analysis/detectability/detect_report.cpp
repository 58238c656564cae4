#include "analysis/detectability/detect_report.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/detectability/detection_probability.h"
#include "core/base/text.h"

namespace railcast {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kKmphPerMps = 3.6;
constexpr double kPermil = 1000.0;

std::string RuleText(const DetectSpec& spec) {
  const DetectionRule& rule = spec.rule;
  return "An object is detected in the first frame in which it has had at least " +
         NumberText(rule.min_points) + " points in " + NumberText(rule.min_frames) +
         " of the last " + NumberText(rule.of_frames) +
         " frames, on the way to its closest point. Its distance is that of the sensor from the "
         "nearest point of its box.";
}

std::string WayText() {
  return "In the way is what reaches, at any time of the approach, into the vehicle's outline on "
         "the own track ahead: as wide and high as a wagon of gauge G1, and as a pantograph above "
         "it. What does not is no reason to brake and is not judged. What is detected too late, "
         "but by the run's first frames, is not judged either: had the run begun farther off, it "
         "might have been in time.";
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

Table BesideTable(const std::vector<Verdict>& verdicts) {
  Table table{
      .key = "beside_the_track",
      .title = "What is beside the track",
      .note =
          "The distance is that of the object's box from the axis of the own track ahead, across, "
          "where it was nearest; absent of what was never ahead. Distances of detection are absent "
          "where it came at once.",
      .columns = ColumnsOf("object: Object; type: Type; from_axis_m: From the axis; runs: Runs; "
                           "detected: Detected; least_detected_at_m: Detected at, at least")};
  for (const Verdict& verdict : verdicts) {
    if (verdict.is_in_way) continue;
    table.rows.push_back({verdict.name, verdict.type,
                          std::isfinite(verdict.from_axis_m) ? verdict.from_axis_m : kNaN,
                          verdict.num_approached, verdict.num_detected, verdict.least_distance_m});
  }
  return table;
}

Table RunTable(const std::vector<DetectRun>& runs) {
  Table table{
      .key = "runs",
      .title = "Each run",
      .note =
          "At once, or begun too near: the run's first frames show the object, which may be seen "
          "from farther off.",
      .columns = ColumnsOf("seed: Seed; object: Object; outcome: Outcome; detected_at_m: Detected "
                           "at; speed_kmph: Speed; gradient_permil: Gradient; braking_distance_m: "
                           "Braking distance; needed_m: Needed; spare_m: To spare")};
  for (const DetectRun& run : runs) {
    for (const auto& [name, detection] : run.detections) {
      const bool is_judged = detection.is_in_way && detection.fate != Fate::kNeverApproached;
      const auto known = [&](double value) { return is_judged ? value : kNaN; };
      table.rows.push_back({run.seed, name, FateText(detection), detection.distance_m,
                            known(kKmphPerMps * detection.speed_mps),
                            known(kPermil * detection.gradient), known(detection.stop_m),
                            known(detection.needed_m), known(detection.spare_m())});
    }
  }
  return table;
}

/// More names than this are counted rather than listed in the headlines.
constexpr std::size_t kMaxNamed = 5;

// Lists the objects for which `is_one` holds: "person, wagon and 3 more".
template <typename IsOne>
std::string NamesOf(const std::vector<Verdict>& verdicts, const IsOne& is_one) {
  std::string names;
  std::size_t num = 0;
  for (const Verdict& verdict : verdicts) {
    if (!is_one(verdict) || ++num > kMaxNamed) continue;
    if (!names.empty()) names += ", ";
    names += verdict.name;
  }
  if (num > kMaxNamed) names += " and " + NumberText(num - kMaxNamed) + " more";
  return names;
}

void AddHeadlines(const std::vector<Verdict>& verdicts, Report& report) {
  std::uint64_t num_judged = 0;
  std::uint64_t num_in_time = 0;
  const Verdict* worst = nullptr;
  for (const Verdict& verdict : verdicts) {
    if (!verdict.is_judged()) continue;
    ++num_judged;
    num_in_time += verdict.is_always_in_time() ? 1U : 0U;
    if (num_judged <= kMaxNamed) report.headlines.push_back({verdict.name, "", verdict.InWords()});
    if (std::isnan(verdict.least_spare_m)) continue;
    if (worst == nullptr || verdict.least_spare_m < worst->least_spare_m) worst = &verdict;
  }
  report.headlines.push_back({"In the way, and judged", "", num_judged});
  report.headlines.push_back({"Always detected in time", "", num_in_time});
  if (worst != nullptr) {
    report.headlines.push_back(
        {"Least distance to spare, " + worst->name, "m", worst->least_spare_m});
  }
  const auto add_names = [&](const char* title, const std::string& names) {
    if (!names.empty()) report.headlines.push_back({title, "", names});
  };
  add_names("Begun too near to judge",
            NamesOf(verdicts, [](const Verdict& each) { return each.is_begun_too_near(); }));
  add_names("Beside the track, not judged",
            NamesOf(verdicts, [](const Verdict& each) { return !each.is_in_way; }));
}

Section VerdictSection(const std::vector<Verdict>& verdicts, const RungUsed& rung) {
  Section section{.key = "verdicts", .title = "In the way"};
  const bool is_any_judged = std::ranges::any_of(verdicts, &Verdict::is_judged);
  if (!is_any_judged) section.paragraphs = {"Nothing that was in the way can be judged."};
  if (const std::string warning = rung.Warning(); !warning.empty()) {
    section.paragraphs.push_back(warning);
  }
  section.tables = {VerdictTable(verdicts), MeansTable(verdicts)};
  return section;
}

Section PointsSection(const std::vector<DetectRun>& runs,
                      const std::vector<Verdict>& verdicts,
                      const DetectionRule& rule) {
  Section section{.key = "points", .title = "Points against distance"};
  for (const bool is_in_way : {true, false}) {
    for (const Verdict& object : verdicts) {
      const bool is_due = object.is_in_way == is_in_way && object.num_approached > 0;
      if (!is_due || section.charts.size() == kMaxCharts) continue;
      section.charts.push_back(PointsChart(runs, object, rule));
    }
  }
  section.tables = {PointsTable(runs, rule)};
  return section;
}

}  // namespace

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

Table VerdictTable(const std::vector<Verdict>& verdicts) {
  Table table{
      .key = "verdicts",
      .title = "Which objects are detected in time to stop",
      .note = "Distances of detection are of the runs that detected the object, but not at once.",
      .columns =
          ColumnsOf("object: Object; type: Type; verdict: Verdict; runs: Runs; "
                    "least_detected_at_m: Detected at, at least; needed_m: Needed, at most; "
                    "least_spare_m: To spare, at least; begun_too_near: Begun too near to tell"),
      .is_open = true};
  for (const Verdict& verdict : verdicts) {
    if (!verdict.is_in_way) continue;
    table.rows.push_back({verdict.name, verdict.type, verdict.InWords(), verdict.num_approached,
                          verdict.least_distance_m, verdict.most_needed_m, verdict.least_spare_m,
                          verdict.num_undecided});
  }
  return table;
}

Table MeansTable(const std::vector<Verdict>& verdicts) {
  Table table{.key = "means",
              .title = "Means over the runs",
              .note =
                  "Of the runs that detected the object, but not at once; the share in time is of "
                  "those that approached it and did not begin too near to tell.",
              .columns = ColumnsOf("object: Object; detected_at_m: Detected at; spare_m: To spare; "
                                   "in_time_percent: In time")};
  for (const Verdict& verdict : verdicts) {
    if (!verdict.is_in_way) continue;
    table.rows.push_back(
        {verdict.name, verdict.distance_m.Mean(), verdict.spare_m.Mean(),
         PercentProportion(verdict.num_in_time, verdict.num_approached - verdict.num_undecided)});
  }
  return table;
}

std::string FateText(const ObjectDetection& detection) {
  if (detection.fate == Fate::kNeverApproached) return "never approached";
  if (!detection.is_in_way) return "beside the track";
  if (detection.fate == Fate::kNeverDetected) return "not detected";
  if (!detection.is_from_start) return detection.is_in_time() ? "in time" : "too late";
  return detection.is_in_time() ? "in time, at once" : "not known: begun too near";
}

Report MakeDetectReport(const std::vector<DetectRun>& runs,
                        const DetectSpec& spec,
                        const std::string& command,
                        std::vector<std::pair<std::string, std::string>> facts,
                        const RungUsed& rung) {
  const std::vector<Verdict> verdicts = MakeVerdicts(runs);
  Report report{.title = "Which objects are detected in time to stop",
                .command = command,
                .facts = std::move(facts)};
  report.facts.emplace_back("Rung", rung.InWords());
  AddHeadlines(verdicts, report);

  report.sections.push_back(VerdictSection(verdicts, rung));
  const bool is_any_beside =
      std::ranges::any_of(verdicts, [](const Verdict& each) { return !each.is_in_way; });
  if (is_any_beside) {
    report.sections.push_back(
        {.key = "beside", .title = "Beside the track", .tables = {BesideTable(verdicts)}});
  }
  report.sections.push_back(MakeProbabilitySection(runs, verdicts));
  report.sections.push_back(PointsSection(runs, verdicts, spec.rule));
  report.sections.push_back({.key = "runs", .title = "Run by run", .tables = {RunTable(runs)}});
  report.sections.push_back(
      {.key = "rules",
       .title = "What is asked",
       .paragraphs = {WayText(), RuleText(spec), BrakingText(spec), RunsText(runs.size())}});
  return report;
}

}  // namespace railcast
