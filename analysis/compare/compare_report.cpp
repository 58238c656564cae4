#include "analysis/compare/compare_report.h"

#include <algorithm>

#include "analysis/report/cell_text.h"
#include "analysis/report/words.h"
#include "analysis/stats/bins.h"
#include "analysis/stats/names.h"
#include "core/base/error.h"
#include "core/base/text.h"

namespace railcast {
namespace {

constexpr double kNanosecondsPerSecond = 1e9;

std::size_t IndexOf(const Comparison& comparison, const std::string& metric) {
  const auto& metrics = comparison.metrics();
  const auto at = std::find_if(metrics.begin(), metrics.end(),
                               [&](const TableColumn& m) { return m.key == metric; });
  Check(at != metrics.end(), "a metric is one of PairMetrics()");
  return static_cast<std::size_t>(at - metrics.begin());
}

bool HasVelocities(const Comparison& comparison) {
  return comparison.histograms_a().velocity.num() + comparison.histograms_b().velocity.num() > 0;
}

// One metric of the pairs, in their order.
ChartSeries OverPairs(const Comparison& comparison,
                      const std::string& metric,
                      const std::string& title) {
  ChartSeries series{title, SeriesStyle::kLine};
  const std::size_t index = IndexOf(comparison, metric);
  for (std::size_t i = 0; i < comparison.pairs().size(); ++i) {
    series.points.push_back(
        {static_cast<double>(i * comparison.pair_stride()), comparison.pairs()[i].values[index]});
  }
  if (series.points.size() < kMinSamples) series.style = SeriesStyle::kLinePoints;
  return series;
}

Table PairsTable(const Comparison& comparison) {
  Table table = TableOf(
      kCompareWords, "pairs",
      {{"stride", comparison.pair_stride() == 1 ? "" : std::to_string(comparison.pair_stride())}});
  std::ranges::copy(comparison.metrics(), std::back_inserter(table.columns));
  for (const PairFigures& pair : comparison.pairs()) {
    std::vector<Cell> row = {std::uint64_t{pair.index_a},
                             std::uint64_t{pair.index_b},
                             static_cast<double>(pair.stamp_a_ns) / kNanosecondsPerSecond,
                             static_cast<double>(pair.stamp_b_ns) / kNanosecondsPerSecond,
                             pair.num_points_a,
                             pair.num_points_b};
    row.insert(row.end(), pair.values.begin(), pair.values.end());
    table.rows.push_back(std::move(row));
  }
  return table;
}

Chart FScoreChart(const Comparison& comparison) {
  Chart chart = ChartOf(kCompareWords, "f_score");
  for (const char* const what : {"precision", "recall", "f_score"}) {
    ChartSeries series{std::string(what) == "f_score" ? "F-score" : what, SeriesStyle::kLinePoints};
    for (std::size_t i = 0; i < comparison.distances_m().size(); ++i) {
      const std::size_t metric =
          IndexOf(comparison, PairMetrics(comparison.distances_m())[7 + 3 * i].key) +
          chart.series.size();
      const Comparison::Summary& summary = comparison.summaries()[metric];
      const Estimate mean = summary.moments.Mean();
      series.points.push_back({comparison.distances_m()[i], summary.Mean(), mean.low, mean.high});
    }
    chart.series.push_back(std::move(series));
  }
  return chart;
}

Section DistancesSection(const Comparison& comparison) {
  Section section =
      SectionOf(kCompareWords, "distances",
                {{"metrics", MetricsInWords()}, {"registers", comparison.registers()}});
  Chart chart = ChartOf(kCompareWords, "distances_by_pair");
  chart.series = {OverPairs(comparison, "chamfer_m", "Chamfer"),
                  OverPairs(comparison, "hausdorff95_m", "Hausdorff, 95 %"),
                  OverPairs(comparison, "hausdorff_m", "Hausdorff")};
  section.charts.push_back(std::move(chart));
  section.charts.push_back(FScoreChart(comparison));
  section.tables = {MetricsTable(comparison), PairsTable(comparison)};
  return section;
}

// A histogram as shares of its total count.
ChartSeries Shares(const Histogram& histogram,
                   const std::string& title,
                   SeriesStyle style,
                   double (*x_of_bin)(std::int64_t)) {
  constexpr double kPercent = 100.0;
  ChartSeries series{title, style};
  std::int64_t next = histogram.counts().empty() ? 0 : histogram.counts().begin()->first;
  for (const auto& [bin, count] : histogram.counts()) {
    // Empty bins are zeros; in a line only the ends of each run of empty bins are needed.
    if (bin > next) series.points.push_back({x_of_bin(next), 0.0});
    if (bin > next + 1) series.points.push_back({x_of_bin(bin - 1), 0.0});
    series.points.push_back({x_of_bin(bin), kPercent * static_cast<double>(count) /
                                                static_cast<double>(histogram.num())});
    next = bin + 1;
  }
  return series;
}

double MiddleOfMetre(std::int64_t bin) {
  return static_cast<double>(bin) + 0.5;
}

double AsNumber(std::int64_t bin) {
  return static_cast<double>(bin);
}

Section DistributionsSection(const Comparison& comparison) {
  Section section = SectionOf(kCompareWords, "distributions");
  const auto add = [&](const char* key, Histogram CloudHistograms::*of,
                       double (*x_of_bin)(std::int64_t), SeriesStyle style = SeriesStyle::kLine) {
    Chart& chart = section.charts.emplace_back(ChartOf(kCompareWords, key));
    chart.series = {Shares(comparison.histograms_a().*of, "A", style, x_of_bin),
                    Shares(comparison.histograms_b().*of, "B", style, x_of_bin)};
  };
  add("ranges", &CloudHistograms::range, MiddleOfMetre);
  add("intensities", &CloudHistograms::intensity, IntensityOfBin);
  add("rings", &CloudHistograms::ring, AsNumber, SeriesStyle::kLinePoints);
  if (HasVelocities(comparison)) add("velocities", &CloudHistograms::velocity, MiddleOfMetre);
  return section;
}

Section BinsSection(const Comparison& comparison) {
  constexpr double kPercent = 100.0;
  const bool has_velocities = HasVelocities(comparison);
  Section section = SectionOf(kCompareWords, "bins", {{"has_velocities", has_velocities}});
  Table table = TableOf(kCompareWords, "by_range", {{"has_velocities", has_velocities}});
  for (std::size_t i = 0; i < RangeBins().size(); ++i) {
    const BinSums::Bin& bin = comparison.bins().bins()[i];
    table.rows.push_back({RangeBins().span(i), bin.points_a.Mean(), bin.points_b.Mean(),
                          Scaled(bin.points_change.Mean(), kPercent), bin.intensity_a.Mean(),
                          bin.intensity_b.Mean(), Scaled(bin.intensity_change.Mean(), kPercent)});
    if (!has_velocities) continue;
    for (const Moments& moments :
         {bin.velocity_a_mps, bin.velocity_b_mps, bin.velocity_change_mps}) {
      table.rows.back().emplace_back(moments.Mean());
    }
  }
  section.charts = {ChartOfTable(kCompareWords, "points_by_range", table),
                    ChartOfTable(kCompareWords, "intensity_by_range", table)};
  if (has_velocities) {
    section.charts.push_back(ChartOfTable(kCompareWords, "velocity_by_range", table));
  }
  section.tables = {std::move(table)};
  return section;
}

std::string Described(const RecordingInfo& info) {
  return Joined({ShownPath(info.source), ", ", info.kind});
}

}  // namespace

Cell MeanOverPairs(const Comparison& comparison, const std::string& metric) {
  const Comparison::Summary& summary = comparison.summaries()[IndexOf(comparison, metric)];
  const Estimate mean = summary.moments.Mean();
  if (mean.is_enough() || summary.moments.num() == 0) return mean;
  return summary.Mean();
}

std::string MetricsInWords() {
  return SentencesOf(kCompareWords, "metrics");
}

Table MetricsTable(const Comparison& comparison) {
  Table table = TableOf(kCompareWords, "metrics");
  const double none = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> of_all(IndexOf(comparison, "jsd_range"), none);
  std::ranges::copy(DistributionFigures(comparison.histograms_a(), comparison.histograms_b(),
                                        comparison.bins().Errors()),
                    std::back_inserter(of_all));
  of_all.resize(comparison.metrics().size(), none);
  for (std::size_t i = 0; i < comparison.metrics().size(); ++i) {
    const TableColumn& metric = comparison.metrics()[i];
    const Comparison::Summary& summary = comparison.summaries()[i];
    const bool is_any = summary.moments.num() > 0;
    table.rows.push_back({metric.title, metric.unit, MeanOverPairs(comparison, metric.key),
                          is_any ? summary.least : none, is_any ? summary.largest : none,
                          of_all[i]});
  }
  return table;
}

Report MakeCompareReport(const Comparison& comparison,
                         const FramePairs& pairs,
                         const RecordingInfo& a,
                         const RecordingInfo& b,
                         const std::string& command) {
  Report report{
      .title = Joined({ShownPath(b.source), " compared with ", ShownPath(a.source)}),
      .command = command,
      .facts = {{"A, the reference", Described(a)},
                {"B", Described(b)},
                {"Pairs", Joined({std::to_string(comparison.num_pairs()), ", by ",
                                  PairingName(pairs.pairing())})},
                {"Without a partner", Joined({std::to_string(pairs.num_alone_a()), " of A, ",
                                              std::to_string(pairs.num_alone_b()), " of B"})}}};
  for (const char* const key :
       {"density_aware_chamfer", "mape_points_percent", "chamfer_m", "hausdorff95_m", "jsd_range",
        "jsd_intensity", "jsd_occupancy", "mape_intensity_percent"}) {
    const TableColumn& metric = comparison.metrics()[IndexOf(comparison, key)];
    report.headlines.push_back({metric.title, metric.unit, MeanOverPairs(comparison, key)});
  }
  if (comparison.registers()) {
    report.headlines.push_back({"Residual of the registration", "m",
                                MeanOverPairs(comparison, "registration_residual_m")});
  }
  report.sections = {DistancesSection(comparison), DistributionsSection(comparison),
                     BinsSection(comparison)};
  const auto factor =
      IntensityFactorOf(comparison.histograms_a().intensity, comparison.histograms_b().intensity);
  if (factor) {
    report.headlines.insert(report.headlines.begin() + 2,
                            {"Scale of B's intensities against A's", "", factor->b_over_a});
    report.sections[1].paragraphs.insert(report.sections[1].paragraphs.begin(), InWords(*factor));
  }
  return report;
}

}  // namespace railcast
