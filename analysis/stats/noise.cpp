#include "analysis/stats/noise.h"

#include <cmath>

#include "analysis/estimate/intervals.h"
#include "analysis/stats/bins.h"
#include "analysis/stats/headings.h"
#include "analysis/stats/sums.h"
#include "core/io/recording/firing_truth.h"

namespace railcast {
namespace {

Estimate PooledSigma(double squares, double degrees, std::uint64_t num_patches) {
  if (num_patches < kMinSamples) return NotEnough(num_patches);
  return ScaleEstimate(std::sqrt(squares / degrees), degrees, num_patches);
}

// The median of sqrt(chi-squared / degrees), by the cube root's normal approximation (Wilson and
// Hilferty 1931): what half of the patches lie below if sigma is 1.
double MedianOfSigma(double degrees) {
  return std::pow(1.0 - 2.0 / (9.0 * degrees), 1.5);
}

Table PlaneTable(const std::vector<Noise::Planes>& planes) {
  Table table;
  table.key = "noise_from_planes";
  table.title = "Noise about local planes";
  table.note =
      "Samples are patches of about 25 points. Robust: median over patches. Roughness counts "
      "as noise.";
  table.columns = {{"range_m", "Range", "m"},
                   {"points", "Points", ""},
                   {"outliers", "Outliers", ""},
                   {"range_sigma_mm", "Along the beam", "mm"},
                   {"robust_range_sigma_mm", "Along the beam, robust", "mm"},
                   {"plane_sigma_mm", "Square to the plane", "mm"},
                   {"robust_plane_sigma_mm", "Square to the plane, robust", "mm"}};
  constexpr double kMm = 1e3;
  for (std::size_t i = 0; i < planes.size(); ++i) {
    const Noise::Planes& bin = planes[i];
    if (bin.num_points == 0) continue;
    table.rows.push_back({RangeBins().Name(i), bin.num_points,
                          Proportion(bin.num_outliers, bin.num_points + bin.num_outliers),
                          Scaled(bin.RangeSigma_m(), kMm), Scaled(bin.RobustRangeSigma_m(), kMm),
                          Scaled(bin.PlaneSigma_m(), kMm), Scaled(bin.RobustPlaneSigma_m(), kMm)});
  }
  return table;
}

Table TruthTable(const std::vector<Noise::Truth>& truth) {
  Table table;
  table.key = "noise_from_truth";
  table.title = "Measured less true range";
  table.note = "Of all points on surfaces.";
  table.columns = {{"range_m", "Range", "m"},
                   {"bias_mm", "Bias", "mm"},
                   {"sigma_mm", "Standard deviation", "mm"},
                   {"robust_sigma_mm", "Standard deviation, robust", "mm"}};
  constexpr double kMm = 1e3;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const Noise::Truth& bin = truth[i];
    if (bin.errors_m.num() == 0) continue;
    table.rows.push_back({RangeBins().Name(i), Scaled(bin.errors_m.Mean(), kMm),
                          Scaled(bin.errors_m.StandardDeviation(), kMm),
                          Scaled(bin.robust_errors_m.RobustScale(), kMm)});
  }
  return table;
}

template <typename Bin, typename Figure>
ChartSeries SeriesOf(const std::string& title, const std::vector<Bin>& bins, Figure figure) {
  constexpr double kMm = 1e3;
  ChartSeries series{title, SeriesStyle::kLinePoints, {}};
  for (std::size_t i = 0; i < bins.size(); ++i) {
    series.points.push_back(PointAt(RangeBins().middle(i), Scaled(figure(bins[i]), kMm)));
  }
  return series;
}

}  // namespace

void Noise::Planes::Add(const Planes& other) {
  degrees += other.degrees;
  range_squares_m2 += other.range_squares_m2;
  plane_squares_m2 += other.plane_squares_m2;
  num_points += other.num_points;
  num_outliers += other.num_outliers;
  range_sigmas_m.Add(other.range_sigmas_m);
  plane_sigmas_m.Add(other.plane_sigmas_m);
}

Estimate Noise::Planes::RangeSigma_m() const {
  return PooledSigma(range_squares_m2, degrees, range_sigmas_m.num());
}

Estimate Noise::Planes::PlaneSigma_m() const {
  return PooledSigma(plane_squares_m2, degrees, plane_sigmas_m.num());
}

void Noise::Truth::Add(const Truth& other) {
  errors_m.Add(other.errors_m);
  robust_errors_m.Add(other.robust_errors_m);
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
    planes.range_sigmas_m.Add(correction * std::sqrt(patch.range_squares_m2 / degrees));
    planes.plane_sigmas_m.Add(correction * std::sqrt(patch.plane_squares_m2 / degrees));
  }
  if (!recorded.Has("true_range_m")) return;
  truth_.resize(RangeBins().size());
  const Frame& frame = recorded.frame;
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    // Of files that hold points only, all outcomes are not known.
    const bool is_known = recorded.Has("outcome");
    if (is_known && frame.outcome[slot] != Outcome::kReturned) continue;
    if (!std::isfinite(frame.range_m[slot])) continue;
    const double true_range_m = static_cast<double>(frame.true_range_m[slot]);
    const auto bin = RangeBins().Find(true_range_m);
    if (!bin) continue;
    const double error_m = static_cast<double>(frame.range_m[slot]) - true_range_m;
    truth_[*bin].errors_m.Add(error_m);
    truth_[*bin].robust_errors_m.Add(error_m);
  }
}

void Noise::Add(const Noise& other) {
  AddEach(planes_, other.planes_);
  AddEach(truth_, other.truth_);
}

Section Noise::MakeSection() const {
  Section section;
  section.key = "noise";
  section.title = "Range noise";
  section.paragraphs = {
      "From small flat pieces of surface: RANSAC, then least squares without outliers, met under "
      "less than 60 deg. Along the beam it is the range noise of a sensor that errs along its "
      "beams; "
      "square to the plane, that of positions that err alike in all directions, as the published "
      "noise does. What is rough counts as noise: on ballast and grass this is an upper bound."};
  Chart chart;
  chart.key = "noise_by_range";
  chart.title = "Range noise against range";
  chart.x = {"Range", "m"};
  chart.y = {"Standard deviation", "mm"};
  chart.series = {SeriesOf("planes, along the beam", planes_,
                           [](const Planes& bin) { return bin.RobustRangeSigma_m(); }),
                  SeriesOf("planes, square to them", planes_,
                           [](const Planes& bin) { return bin.RobustPlaneSigma_m(); })};
  chart.caption = "Robust estimates.";
  if (!truth_.empty()) {
    chart.series.push_back(SeriesOf("measured less true range", truth_, [](const Truth& bin) {
      return bin.robust_errors_m.RobustScale();
    }));
    section.tables.push_back(TruthTable(truth_));
    section.paragraphs.emplace_back("Frames hold the truth: measured less true range is exact.");
  }
  section.tables.push_back(PlaneTable(planes_));
  section.charts.push_back(std::move(chart));
  return section;
}

}  // namespace railcast
