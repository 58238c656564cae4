#include "analysis/compare/distance_bins.h"

#include <cmath>

#include "analysis/stats/bins.h"

namespace railcast {
namespace {

constexpr double kPercentOf = 100.0;

double RelativeChangeOf(double from, double to) {
  return (to - from) / from;
}

BinnedCloud EmptyBins() {
  return {std::vector<BinnedCloud::Bin>(RangeBins().size())};
}

void AddTo(BinnedCloud& sum, const BinnedCloud& cloud) {
  for (std::size_t i = 0; i < sum.bins.size(); ++i) {
    sum.bins[i].num_points += cloud.bins[i].num_points;
    sum.bins[i].num_intensities += cloud.bins[i].num_intensities;
    sum.bins[i].intensity_sum += cloud.bins[i].intensity_sum;
  }
}

double PointsOf(const BinnedCloud::Bin& bin) {
  return static_cast<double>(bin.num_points);
}

// A running mean.
struct Mean {
  double sum{};
  int num{};

  void Add(double value) {
    if (!std::isfinite(value)) return;
    sum += value;
    ++num;
  }
  [[nodiscard]] double value() const {
    return num == 0 ? std::numeric_limits<double>::quiet_NaN() : sum / num;
  }
};

}  // namespace

double BinnedCloud::Bin::MeanIntensity() const {
  if (num_intensities < kMinSamples) return std::numeric_limits<double>::quiet_NaN();
  return intensity_sum / static_cast<double>(num_intensities);
}

BinnedCloud BinnedByRange(const ComparedCloud& cloud) {
  BinnedCloud binned = EmptyBins();
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const auto found = RangeBins().Find(static_cast<double>(cloud.range_m[i]));
    if (!found) continue;
    BinnedCloud::Bin& bin = binned.bins[*found];
    ++bin.num_points;
    if (cloud.intensity.empty() || !std::isfinite(cloud.intensity[i])) continue;
    ++bin.num_intensities;
    bin.intensity_sum += static_cast<double>(cloud.intensity[i]);
  }
  return binned;
}

BinErrors ErrorsOf(const BinnedCloud& a, const BinnedCloud& b) {
  Mean points, intensity;
  for (std::size_t i = 0; i < a.bins.size(); ++i) {
    if (a.bins[i].num_points < kMinSamples) continue;
    points.Add(std::abs(RelativeChangeOf(PointsOf(a.bins[i]), PointsOf(b.bins[i]))));
    intensity.Add(std::abs(RelativeChangeOf(a.bins[i].MeanIntensity(), b.bins[i].MeanIntensity())));
  }
  return {kPercentOf * points.value(), kPercentOf * intensity.value()};
}

BinSums::BinSums() : bins_(RangeBins().size()), sum_a_(EmptyBins()), sum_b_(EmptyBins()) {}

void BinSums::Add(const BinnedCloud& a, const BinnedCloud& b) {
  for (std::size_t i = 0; i < bins_.size(); ++i) {
    Bin& bin = bins_[i];
    const double points_a = PointsOf(a.bins[i]), points_b = PointsOf(b.bins[i]);
    const double intensity_a = a.bins[i].MeanIntensity(), intensity_b = b.bins[i].MeanIntensity();
    bin.points_a.Add(points_a);
    bin.points_b.Add(points_b);
    bin.intensity_a.Add(intensity_a);
    bin.intensity_b.Add(intensity_b);
    if (a.bins[i].num_points >= kMinSamples) {
      bin.points_change.Add(RelativeChangeOf(points_a, points_b));
      const double change = RelativeChangeOf(intensity_a, intensity_b);
      if (std::isfinite(change)) bin.intensity_change.Add(change);
    }
  }
  AddTo(sum_a_, a);
  AddTo(sum_b_, b);
}

}  // namespace railcast
