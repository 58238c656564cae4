#include <algorithm>
#include <functional>

#include "analysis/compare/compare_report.h"
#include "analysis/report/cell_text.h"
#include "analysis/stats/bins.h"
#include "analysis/stats/names.h"
#include "core/detect/detector/effect_table.h"

namespace railcast {
namespace {

constexpr double kPercent = 100.0;
// More lines than this in one chart cannot be told apart.
constexpr std::size_t kMaxLines = 7;

std::string NameOf(const EffectStudy& study) {
  if (study.rung) return Joined({InWords(study.effect), " (on ", NameOf(*study.rung), ")"});
  return Joined({InWords(study.effect), study.is_in_scenario ? "" : " (switched on)"});
}

std::string WhereStudied(const EffectStudy& study) {
  if (study.rung) return "on " + std::string(NameOf(*study.rung));
  return study.is_in_scenario ? "on" : "off";
}

std::uint64_t NumChanged(const EffectStudy& study) {
  return study.beams.num_beams - study.beams.num_identical;
}

std::uint64_t NumOutcomeChanged(const EffectStudy& study) {
  return study.beams.num_outcome_changed;
}

// Sorts by the given number, largest first.
std::vector<const EffectStudy*> Sorted(
    const std::vector<EffectStudy>& studies,
    const std::function<std::uint64_t(const EffectStudy&)>& num) {
  std::vector<const EffectStudy*> sorted;
  for (const EffectStudy& study : studies) sorted.push_back(&study);
  std::stable_sort(sorted.begin(), sorted.end(),
                   [&](const EffectStudy* a, const EffectStudy* b) { return num(*a) > num(*b); });
  return sorted;
}

Chart ChangedChart(const std::vector<const EffectStudy*>& studies) {
  Chart chart = {"changed_beams",
                 "What each effect changes",
                 "The longest bars are the effects that matter most here: beams whose position, "
                 "intensity, range or outcome differ in any bit, and those whose outcome differs.",
                 {},
                 {"Share of beams", "%"},
                 {{"anything", SeriesStyle::kBars}, {"outcome", SeriesStyle::kBars}}};
  for (const EffectStudy* const study : studies) {
    const auto x = static_cast<double>(chart.x.categories.size());
    chart.x.categories.push_back(NameOf(*study));
    const BeamChanges& beams = study->beams;
    chart.series[0].points.push_back(
        PointAt(x, PercentProportion(NumChanged(*study), beams.num_beams)));
    chart.series[1].points.push_back(
        PointAt(x, PercentProportion(beams.num_outcome_changed, beams.num_beams)));
  }
  return chart;
}

Chart ReturnsChart(const std::vector<const EffectStudy*>& studies) {
  Chart chart = {"returns",
                 "Points that each effect takes away and adds",
                 "The longest bars are the effects that cost or give most points, in percent of "
                 "those without the effect.",
                 {},
                 {"Points", "%"},
                 {{"taken away", SeriesStyle::kBars}, {"added", SeriesStyle::kBars}}};
  for (const EffectStudy* const study : studies) {
    const auto x = static_cast<double>(chart.x.categories.size());
    chart.x.categories.push_back(NameOf(*study));
    const BeamChanges& beams = study->beams;
    const std::uint64_t num_without = beams.num_both + beams.num_removed;
    chart.series[0].points.push_back({x, Percent(beams.num_removed, num_without)});
    chart.series[1].points.push_back({x, Percent(beams.num_added, num_without)});
  }
  return chart;
}

Table EffectsTable(const std::vector<EffectStudy>& studies) {
  Table table = {
      "effects", "What each effect changes",
      "Without the effect against with it, the same draws. Identical beams are the same in every "
      "bit of position, intensity, range and outcome. Points moved and intensities changed are of "
      "those that are there both times.",
      ColumnsOf("effect: Effect; in_scenario: In the scenario; beams: Beams; identical_percent: "
                "Identical beams; outcome_percent: Outcome changed; points_taken: Points taken "
                "away; points_added: Points added; moved_percent: Points moved; moved_median_m: "
                "Moved by, median; moved_95_m: Moved by, 95 %; intensity_percent: Intensity "
                "changed; intensity_median: Intensity changed by, median; intensity_95: Intensity "
                "changed by, 95 %")};
  for (const EffectStudy& study : studies) {
    const BeamChanges& beams = study.beams;
    constexpr double kShare = 0.95;
    table.rows.push_back(
        {study.effect, WhereStudied(study), beams.num_beams,
         PercentProportion(beams.num_identical, beams.num_beams),
         PercentProportion(beams.num_outcome_changed, beams.num_beams), beams.num_removed,
         beams.num_added, PercentProportion(beams.num_moved, beams.num_both),
         beams.moved_m.Median(), beams.moved_m.Quantile(kShare),
         PercentProportion(beams.num_intensity_changed, beams.num_both),
         beams.intensity_change.Median(), beams.intensity_change.Quantile(kShare)});
  }
  return table;
}

// What a mean over frames does not show: one frame may change and all others stay.
Table FrameToFrameTable(const std::vector<EffectStudy>& studies) {
  Table table = {
      "frames", "What each effect changes, from frame to frame",
      "Shares of a frame's beams: those whose outcome changed, and points taken away or added.",
      ColumnsOf(
          "effect: Effect; frames: Frames; outcome_least_percent: Outcome changed, least; "
          "outcome_median_percent: Outcome changed, median; outcome_most_percent: Outcome changed, "
          "most; points_least_percent: Points taken or added, least; points_median_percent: Points "
          "taken or added, median; points_most_percent: Points taken or added, most")};
  for (const EffectStudy& study : studies) {
    std::vector<Cell> row = {study.effect, study.frames.size()};
    for (const auto share : {&FrameChanges::outcome, &FrameChanges::points}) {
      std::vector<double> percents;
      for (const FrameChanges& frame : study.frames) percents.push_back(kPercent * frame.*share);
      const auto [least, most] = std::ranges::minmax(percents);
      row.insert(row.end(), {least, Median(percents), most});
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

Section EffectsSection(const std::vector<EffectStudy>& studies) {
  Section section{
      .key = "effects",
      .title = "Beam by beam",
      .paragraphs = {"Each effect is switched by itself, all others staying as they are, with the "
                     "same seed: its draws are its own, so that beams which it leaves alone are "
                     "the same in every bit. Intervals of shares take beams as independent."}};
  std::string rest;
  for (const std::string& name : EffectNames()) {
    const auto is_it = [&](const EffectStudy& study) { return study.effect == name; };
    if (std::none_of(studies.begin(), studies.end(), is_it)) rest += ", " + InWords(name);
  }
  if (!rest.empty()) {
    section.paragraphs.push_back(
        "Not studied, because they do not go together with what the scenario has: " +
        rest.substr(2) + ".");
  }
  const std::vector<const EffectStudy*> sorted = Sorted(studies, NumChanged);
  section.charts = {ChangedChart(sorted), ReturnsChart(sorted)};
  section.tables = {EffectsTable(studies), FrameToFrameTable(studies)};
  return section;
}

// Charts only the effects that change most.
Chart RangeChart(const std::vector<EffectStudy>& studies,
                 const std::string& key,
                 const std::string& title,
                 std::uint64_t BeamChanges::RangeBin::*num_changed) {
  Chart chart = {key,
                 title,
                 "The highest line is the effect that matters most at that range",
                 {"Range", "m", true},
                 {"Share of beams", "%"}};
  const auto sum = [&](const EffectStudy& study) {
    std::uint64_t num = 0;
    for (const BeamChanges::RangeBin& bin : study.beams.range_bins) num += bin.*num_changed;
    return num;
  };
  for (const EffectStudy* const study : Sorted(studies, sum)) {
    if (sum(*study) == 0 || chart.series.size() == kMaxLines) break;
    ChartSeries series{NameOf(*study), SeriesStyle::kLinePoints};
    for (std::size_t bin = 0; bin < RangeBins().size(); ++bin) {
      const BeamChanges::RangeBin& counts = study->beams.range_bins[bin];
      if (counts.num_beams == 0) continue;
      series.points.push_back(PointAt(RangeBins().middle(bin),
                                      PercentProportion(counts.*num_changed, counts.num_beams)));
    }
    chart.series.push_back(std::move(series));
  }
  chart.caption.text +=
      chart.series.size() == kMaxLines ? ", of the seven effects that change most beams." : ".";
  return chart;
}

Section RangeSection(const std::vector<EffectStudy>& studies) {
  Section section{.key = "by_range",
                  .title = "By range",
                  .paragraphs = {"Shares of the beams that meet a surface at this range."},
                  .charts = {RangeChart(studies, "outcome_by_range", "Beams with another outcome",
                                        &BeamChanges::RangeBin::num_outcome_changed),
                             RangeChart(studies, "changed_by_range", "Beams that change at all",
                                        &BeamChanges::RangeBin::num_changed)}};
  Table table = {"changed_by_range", "Changed beams by range", "", ColumnsOf("range_m: Range")};
  for (const EffectStudy& study : studies) {
    table.columns.push_back({study.effect + "_percent", InWords(study.effect), "%"});
  }
  for (std::size_t bin = 0; bin < RangeBins().size(); ++bin) {
    std::vector<Cell> row = {RangeBins().span(bin)};
    for (const EffectStudy& study : studies) {
      const BeamChanges::RangeBin& counts = study.beams.range_bins[bin];
      row.emplace_back(PercentProportion(counts.num_changed, counts.num_beams));
    }
    table.rows.push_back(std::move(row));
  }
  section.tables = {std::move(table)};
  return section;
}

// How many more beams have each outcome with the effect than without it.
Table OutcomesTable(const std::vector<EffectStudy>& studies) {
  Table table = {"outcomes", "Beams gained and lost by each outcome",
                 "How many more beams end so with the effect than without it.",
                 ColumnsOf("effect: Effect")};
  for (const std::string_view name : kOutcomeNames) {
    table.columns.push_back({std::string(name), InWords(name), ""});
  }
  for (const EffectStudy& study : studies) {
    std::vector<Cell> row = {study.effect};
    for (std::size_t outcome = 0; outcome < BeamChanges::kNumOutcomes; ++outcome) {
      double change = 0.0;
      for (std::size_t other = 0; other < BeamChanges::kNumOutcomes; ++other) {
        change += static_cast<double>(study.beams.transitions[other][outcome]);
        change -= static_cast<double>(study.beams.transitions[outcome][other]);
      }
      row.emplace_back(change);
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table TransitionsTable(const std::vector<EffectStudy>& studies) {
  Table table = {"transitions", "What became of which beams", "",
                 ColumnsOf("effect: Effect; without: Without it; with: With it; beams: Beams; "
                           "share_percent: Share of those without it")};
  for (const EffectStudy& study : studies) {
    for (std::size_t from = 0; from < BeamChanges::kNumOutcomes; ++from) {
      const auto& row = study.beams.transitions[from];
      std::uint64_t num_from = 0;
      for (const std::uint64_t num : row) num_from += num;
      for (std::size_t to = 0; to < BeamChanges::kNumOutcomes; ++to) {
        if (from == to || row[to] == 0) continue;
        table.rows.push_back({study.effect, InWords(kOutcomeNames[from]),
                              InWords(kOutcomeNames[to]), row[to],
                              PercentProportion(row[to], num_from)});
      }
    }
  }
  return table;
}

Section OutcomesSection(const std::vector<EffectStudy>& studies) {
  Section section{.key = "outcomes",
                  .title = "Outcomes",
                  .tables = {OutcomesTable(studies), TransitionsTable(studies)}};
  return section;
}

Chart CloudChart(const std::vector<EffectStudy>& studies,
                 const std::string& metric,
                 const std::string& title,
                 const std::string& unit) {
  Chart chart = {metric,
                 title,
                 "The longest bar is the effect that changes the cloud most; effects in the order "
                 "of the beams that they change.",
                 {},
                 {title, unit},
                 {{"", SeriesStyle::kBars}}};
  for (const EffectStudy* const study : Sorted(studies, NumChanged)) {
    const Cell mean = MeanOverPairs(study->clouds, metric);
    const auto x = static_cast<double>(chart.x.categories.size());
    chart.x.categories.push_back(NameOf(*study));
    chart.series[0].points.push_back(std::holds_alternative<Estimate>(mean)
                                         ? PointAt(x, std::get<Estimate>(mean))
                                         : ChartPoint{x, std::get<double>(mean)});
  }
  return chart;
}

Section CloudsSection(const std::vector<EffectStudy>& studies) {
  Section section{.key = "clouds", .title = "Cloud against cloud", .paragraphs = MetricsInWords()};
  section.paragraphs.emplace_back("A is the cloud without the effect, B the one with it.");
  section.charts = {
      CloudChart(studies, "chamfer_m", "Chamfer distance", "m"),
      CloudChart(studies, "density_aware_chamfer", "Density-aware Chamfer distance", "")};
  Table table = {"clouds", "Metrics of clouds, means over frames", "", ColumnsOf("effect: Effect")};
  if (!studies.empty()) {
    std::ranges::copy(studies.front().clouds.metrics(), std::back_inserter(table.columns));
  }
  for (const EffectStudy& study : studies) {
    std::vector<Cell> row = {study.effect};
    for (const TableColumn& metric : study.clouds.metrics()) {
      row.push_back(MeanOverPairs(study.clouds, metric.key));
    }
    table.rows.push_back(std::move(row));
  }
  section.tables = {std::move(table)};
  return section;
}

}  // namespace

Report MakeAblationReport(const std::vector<EffectStudy>& studies,
                          const std::string& title,
                          const std::vector<std::pair<std::string, std::string>>& facts,
                          const std::string& command) {
  Report report{.title = title, .command = command, .facts = facts};
  constexpr std::size_t kMaxHeadlines = 6;
  for (const EffectStudy* const study : Sorted(studies, NumOutcomeChanged)) {
    if (NumOutcomeChanged(*study) == 0 || report.headlines.size() == kMaxHeadlines) break;
    report.headlines.push_back(
        {Joined({"Beams with another outcome by ", NameOf(*study)}), "%",
         PercentProportion(study->beams.num_outcome_changed, study->beams.num_beams)});
  }
  report.sections = {EffectsSection(studies), RangeSection(studies), OutcomesSection(studies),
                     CloudsSection(studies)};
  return report;
}

}  // namespace railcast
