#include "analysis/detectability/detect_report.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/detectability/detection_probability.h"
#include "analysis/report/words.h"
#include "core/base/text.h"

namespace railcast {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kKmphPerMps = 3.6;
constexpr double kPermil = 1000.0;

Table BesideTable(const std::vector<Verdict>& verdicts) {
  Table table = TableOf(kDetectabilityWords, "beside_the_track");
  for (const Verdict& verdict : verdicts) {
    if (verdict.is_in_way) continue;
    table.rows.push_back({verdict.name, verdict.type,
                          std::isfinite(verdict.from_axis_m) ? verdict.from_axis_m : kNaN,
                          verdict.num_approached, verdict.num_detected, verdict.least_distance_m});
  }
  return table;
}

Table RunTable(const std::vector<DetectRun>& runs) {
  Table table = TableOf(kDetectabilityWords, "runs");
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
  const bool is_any_judged = std::ranges::any_of(verdicts, &Verdict::is_judged);
  Section section = SectionOf(kDetectabilityWords, "verdicts",
                              {{"is_any_judged", is_any_judged}, {"warning", rung.Warning()}});
  section.tables = {VerdictTable(verdicts), MeansTable(verdicts)};
  return section;
}

Section PointsSection(const std::vector<DetectRun>& runs,
                      const std::vector<Verdict>& verdicts,
                      const DetectionRule& rule) {
  Section section = SectionOf(kDetectabilityWords, "points");
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
  return SentencesOf(kDetectabilityWords, "braking",
                     {{"reaction_s", NumberText(braking.reaction_s)},
                      {"deceleration_mps2", NumberText(braking.deceleration_mps2)},
                      {"margin_m", NumberText(braking.margin_m)},
                      {"is_given", spec.speed_mps.has_value()}});
}

Table VerdictTable(const std::vector<Verdict>& verdicts) {
  Table table = TableOf(kDetectabilityWords, "verdicts");
  for (const Verdict& verdict : verdicts) {
    if (!verdict.is_in_way) continue;
    table.rows.push_back({verdict.name, verdict.type, verdict.InWords(), verdict.num_approached,
                          verdict.least_distance_m, verdict.most_needed_m, verdict.least_spare_m,
                          verdict.num_undecided});
  }
  return table;
}

Table MeansTable(const std::vector<Verdict>& verdicts) {
  Table table = TableOf(kDetectabilityWords, "means");
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
    Section& beside = report.sections.emplace_back(SectionOf(kDetectabilityWords, "beside"));
    beside.tables = {BesideTable(verdicts)};
  }
  report.sections.push_back(MakeProbabilitySection(runs, verdicts));
  report.sections.push_back(PointsSection(runs, verdicts, spec.rule));
  Section& each = report.sections.emplace_back(SectionOf(kDetectabilityWords, "runs"));
  each.tables = {RunTable(runs)};
  const DetectionRule& rule = spec.rule;
  report.sections.push_back(SectionOf(kDetectabilityWords, "rules",
                                      {{"min_points", NumberText(rule.min_points)},
                                       {"min_frames", NumberText(rule.min_frames)},
                                       {"of_frames", NumberText(rule.of_frames)},
                                       {"braking", BrakingText(spec)},
                                       {"num_runs", NumberText(runs.size())},
                                       {"min_samples", NumberText(kMinSamples)},
                                       {"one", runs.size() == 1},
                                       {"few", runs.size() != 1 && runs.size() < kMinSamples},
                                       {"many", runs.size() >= kMinSamples}}));
  return report;
}

}  // namespace railcast
