#include "analysis/compare/compare_report.h"

#include <algorithm>

#include "analysis/report/cell_text.h"
#include "analysis/report/chart_columns.h"
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
  Table table = {"pairs", "Pairs of frames",
                 comparison.pair_stride() == 1
                     ? ""
                     : Joined({"One of ", std::to_string(comparison.pair_stride()), " pairs."}),
                 ColumnsOf("frame_a: Frame of A; frame_b: Frame of B; stamp_a_s: Stamp of A; "
                           "stamp_b_s: Stamp of B; points_a: Points of A; points_b: Points of B")};
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
  Chart chart = {"f_score",
                 "How much of each cloud the other has",
                 "The sooner a line comes near 100 %, the closer the clouds: precision is the "
                 "share of B's points with one of A within the distance, recall that of A's with "
                 "one of B; means over pairs.",
                 {"Distance", "m", true},
                 {"Share", "%"}};
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
  Section section{
      .key = "distances", .title = "How far the clouds are apart", .paragraphs = MetricsInWords()};
  if (comparison.registers()) {
    section.paragraphs.emplace_back(
        "Each cloud of B was first laid on its partner: iterative closest points, from points to "
        "planes (Chen and Medioni 1992), by PCL, on clouds thinned to cubes of 0.4 m. The residual "
        "is the root mean square of the distances of nearest points up to 2 m that remains.");
  }
  section.charts.push_back({"distances_by_pair",
                            "Distances from pair to pair",
                            "A level line is a drive along which the clouds stay equally far "
                            "apart; a peak is a pair to look at.",
                            {"Pair", ""},
                            {"Distance", "m", true},
                            {OverPairs(comparison, "chamfer_m", "Chamfer"),
                             OverPairs(comparison, "hausdorff95_m", "Hausdorff, 95 %"),
                             OverPairs(comparison, "hausdorff_m", "Hausdorff")}});
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
  Section section{.key = "distributions",
                  .title = "How points are distributed",
                  .paragraphs = {"Shares of all points of all pairs. The divergences in the table "
                                 "of metrics compare these "
                                 "distributions: 0 bit is the same, 1 bit has nothing in common."}};
  const auto add = [&](Chart chart, Histogram CloudHistograms::*of,
                       double (*x_of_bin)(std::int64_t), SeriesStyle style = SeriesStyle::kLine) {
    chart.y = {"Share of points", "%"};
    chart.series = {Shares(comparison.histograms_a().*of, "A", style, x_of_bin),
                    Shares(comparison.histograms_b().*of, "B", style, x_of_bin)};
    section.charts.push_back(std::move(chart));
  };
  add({"ranges",
       "Ranges",
       "Where the lines part, one cloud has more of its points at that range; bins of 1 m.",
       {"Range", "m"}},
      &CloudHistograms::range, MiddleOfMetre);
  add({"intensities",
       "Intensities",
       "Lines of one shape beside each other differ by a scale; bins of an eighth octave, what is "
       "0.001 or less in the first.",
       {"Intensity", "", true}},
      &CloudHistograms::intensity, IntensityOfBin);
  add({"rings",
       "Rings",
       "Where the lines part, one cloud has more of its points on that ring; ring 0 looks lowest.",
       {"Ring", ""}},
      &CloudHistograms::ring, AsNumber, SeriesStyle::kLinePoints);
  if (HasVelocities(comparison)) {
    add({"velocities",
         "Velocities along the beams",
         "Where the lines part, one cloud has more of its points at that velocity; bins of 1 m/s.",
         {"Velocity", "m/s"}},
        &CloudHistograms::velocity, MiddleOfMetre);
  }
  return section;
}

// @param what "points", in keys.
Chart BinChart(const Table& table,
               const std::string& what,
               const ChartAxis& y,
               const std::string& unit = "") {
  return {what + "_by_range",
          y.title,
          "Where the lines part, the recordings differ at that range by more than their bands.",
          {"Range", "m", true},
          y,
          {SeriesOf(table, {"range_m", Joined({what, "_a", unit})}, "A"),
           SeriesOf(table, {"range_m", Joined({what, "_b", unit})}, "B")}};
}

Section BinsSection(const Comparison& comparison) {
  constexpr double kPercent = 100.0;
  Section section{
      .key = "bins",
      .title = "Points and intensity by distance",
      .paragraphs = {
          "Changes are (B - A) / A, as means over pairs in which A has at least 10 points in the "
          "bin. MAPE is the mean of their absolute values over bins (Haider et al. 2022)."}};
  std::string columns =
      "range_m: Range; points_a: Points of A a frame; points_b: Points of B a frame; "
      "points_change_percent: Change of points; intensity_a: Mean intensity of A; "
      "intensity_b: Mean intensity of B; intensity_change_percent: Change of mean intensity";
  const bool has_velocities = HasVelocities(comparison);
  if (has_velocities) {
    columns +=
        "; velocity_a_mps: Mean velocity of A; velocity_b_mps: Mean velocity of B; "
        "velocity_change_mps: Change of mean velocity";
    section.paragraphs.emplace_back(
        "Velocities, which may be 0, change by B - A itself, and their error is the mean of its "
        "absolute values over bins.");
  }
  Table table = {"by_range", "By distance", "", ColumnsOf(columns)};
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
  section.charts = {BinChart(table, "points", {"Points a frame", "", true}),
                    BinChart(table, "intensity", {"Mean intensity", ""})};
  if (has_velocities) {
    section.charts.push_back(BinChart(table, "velocity", {"Mean velocity", "m/s"}, "_mps"));
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

std::vector<std::string> MetricsInWords() {
  return {
      "Points are compared in the sensor's axes. The Chamfer distance is the mean of two means: of "
      "the distances of A's points from the nearest of B, and of B's from the nearest of A (Yuan "
      "et al. 2018, CD-P); that of squares is the sum of the mean squares (Fan et al. 2017). The "
      "Hausdorff distance is the largest of all these distances, that of 95 % the larger of the "
      "two 95th percentiles.",
      "The density-aware Chamfer distance (Wu et al. 2021, alpha = 10 per metre) also counts where "
      "many points share one nearest point; 0 is the same, 1 nothing in common. Precision is the "
      "share of B's points with one of A within a distance, recall that of A's with one of B, the "
      "F-score their harmonic mean (Knapitsch et al. 2017). Divergences are those of Jensen and "
      "Shannon, in bits."};
}

Table MetricsTable(const Comparison& comparison) {
  Table table = {"metrics", "All metrics",
                 "Mean with its 95 % interval over pairs, taken as independent; fewer than 10 "
                 "pairs are not enough for one. Frames of one drive are alike: the interval of a "
                 "drive's mean is narrower than that of drives.",
                 ColumnsOf("metric: Metric; unit: Unit; mean: Mean over pairs; least: Least; "
                           "largest: Largest; all_pairs: All pairs as one")};
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
