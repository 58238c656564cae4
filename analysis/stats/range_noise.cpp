#include "analysis/stats/range_noise.h"

#include <cmath>

#include "analysis/estimate/estimate.h"
#include "analysis/report/chart_columns.h"
#include "analysis/report/words.h"
#include "analysis/stats/bins.h"
#include "core/base/units.h"

namespace railcast {
namespace {

constexpr double kMm = 1e3;

Estimate PooledSigma(double squares, double degrees, std::uint64_t num_patches) {
  if (num_patches < kMinSamples) return NotEnough(num_patches);
  return ScaleEstimate(std::sqrt(squares / degrees), degrees, num_patches);
}

// The median of sqrt(chi-squared / degrees), by the
// cube-root normal approximation (Wilson and Hilferty 1931): half of the patches
// have a standard deviation below it if sigma is 1.
double MedianOfSigma(double degrees) {
  return std::pow(1.0 - 2.0 / (9.0 * degrees), 1.5);
}

Table NoisePlaneTable(const std::vector<Noise::Planes>& planes) {
  Moments step_m;
  for (const Noise::Planes& bin : planes) step_m.Add(bin.step_m);
  Table table = TableOf(kStatsWords, "noise_from_planes", {StepValue(step_m)});
  for (std::size_t i = 0; i < planes.size(); ++i) {
    const Noise::Planes& bin = planes[i];
    if (bin.num_points == 0) continue;
    table.rows.push_back({RangeBins().span(i), bin.num_points,
                          PercentProportion(bin.num_outliers, bin.num_points + bin.num_outliers),
                          Scaled(bin.RangeSigma_m(), kMm), Scaled(bin.RobustRangeSigma_m(), kMm),
                          Scaled(bin.PlaneSigma_m(), kMm), Scaled(bin.RobustPlaneSigma_m(), kMm)});
  }
  return table;
}

Table PclTable(const std::vector<Noise::Planes>& planes) {
  Table table = TableOf(kStatsWords, "noise_by_pcl");
  for (std::size_t i = 0; i < planes.size(); ++i) {
    const Noise::Planes& bin = planes[i];
    const std::uint64_t num_points = bin.num_points + bin.num_outliers;
    if (bin.pcl_sigmas_m.num() == 0) continue;
    table.rows.push_back({RangeBins().span(i), Scaled(bin.pcl_sigmas_m.Median(), kMm),
                          Scaled(bin.RobustPlaneSigma_m(), kMm),
                          Scaled(bin.pcl_turns_rad.Median(), DegFromRad(1.0)),
                          Scaled(bin.pcl_normals_rad.Median(), DegFromRad(1.0)),
                          PercentProportion(bin.num_pcl_outliers, num_points),
                          PercentProportion(bin.num_outliers, num_points)});
  }
  return table;
}

Table TruthTable(const std::vector<Scatter>& truth) {
  Table table = TableOf(kStatsWords, "noise_from_truth");
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (truth[i].num() == 0) continue;
    table.rows.push_back({RangeBins().span(i), Scaled(truth[i].plain.Mean(), kMm),
                          Scaled(truth[i].plain.StandardDeviation(), kMm),
                          Scaled(truth[i].robust.RobustScale(), kMm)});
  }
  return table;
}

}  // namespace

Estimate Noise::Planes::RangeSigma_m() const {
  return PooledSigma(range_squares_m2, degrees, range_sigmas_m.num());
}

Estimate Noise::Planes::PlaneSigma_m() const {
  return PooledSigma(plane_squares_m2, degrees, plane_sigmas_m.num());
}

Estimate Noise::Planes::RobustRangeSigma_m() const {
  return WithoutRounding(range_sigmas_m.Median(), step_m.PlainMean());
}

Estimate Noise::Planes::RobustPlaneSigma_m() const {
  // Errors along the beams, as they are square to the planes.
  const double slant = std::sqrt(plane_squares_m2 / range_squares_m2);
  return WithoutRounding(plane_sigmas_m.Median(), slant * step_m.PlainMean());
}

void Noise::Add(const RecordedFrame& recorded, const std::vector<PlanePatch>& patches) {
  planes_.resize(RangeBins().size());
  for (const PlanePatch& patch : patches) {
    const auto bin = RangeBins().Find(patch.range_m);
    if (!bin) continue;
    Planes& planes = planes_[*bin];
    const double degrees = patch.degrees();
    const double correction = 1.0 / MedianOfSigma(degrees);
    planes.degrees += degrees;
    planes.range_squares_m2 += patch.range_squares_m2;
    planes.plane_squares_m2 += patch.plane_squares_m2;
    planes.num_points += patch.num_points;
    planes.num_outliers += patch.num_outliers;
    if (patch.step_m > 0.0) planes.step_m.Add(patch.step_m);
    planes.range_sigmas_m.Add(correction * std::sqrt(patch.range_squares_m2 / degrees));
    planes.plane_sigmas_m.Add(correction * std::sqrt(patch.plane_squares_m2 / degrees));
    planes.pcl_sigmas_m.Add(patch.by_pcl.sigma_m);
    planes.num_pcl_outliers += patch.by_pcl.num_outliers;
    if (std::isnan(patch.by_pcl.sigma_m)) continue;
    planes.pcl_turns_rad.Add(patch.by_pcl.turn_rad);
    planes.pcl_normals_rad.Add(patch.by_pcl.normals_rad);
  }
  if (!recorded.Has("true_range_m")) return;
  truth_.resize(RangeBins().size());
  const Frame& frame = recorded.frame;
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    if (!HasSurfacePoint(recorded, slot)) continue;
    const double true_range_m = static_cast<double>(frame.true_range_m[slot]);
    const auto bin = RangeBins().Find(true_range_m);
    if (!bin) continue;
    truth_[*bin].Add(static_cast<double>(frame.range_m[slot]) - true_range_m);
  }
}

Section Noise::MakeSection() const {
  Section section = SectionOf(kStatsWords, "noise", {{"has_truth", !truth_.empty()}});
  const Table planes = NoisePlaneTable(planes_);
  Chart chart = ChartOfTable(kStatsWords, "noise_by_range", planes);
  if (!truth_.empty()) {
    const Table truth = TruthTable(truth_);
    chart.series.push_back(
        SeriesOf(truth, {"range_m", "robust_sigma_mm"}, "measured minus true range"));
    section.tables.push_back(truth);
  }
  section.tables.push_back(planes);
  section.tables.push_back(PclTable(planes_));
  section.charts.push_back(std::move(chart));
  return section;
}

}  // namespace railcast
