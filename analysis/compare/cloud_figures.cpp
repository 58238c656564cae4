#include "analysis/compare/cloud_figures.h"

#include <algorithm>
#include <array>

#include "analysis/stats/bins.h"
#include "analysis/stats/sums.h"

namespace railcast {
namespace {

constexpr double kLeastIntensity = 0.001;

std::int64_t BinOfIntensity(double intensity) {
  return static_cast<std::int64_t>(
      std::floor(kIntensityBinsAnOctave * std::log2(std::max(intensity, kLeastIntensity))));
}

// One term of an entropy in bits: -p log2 p.
double Bits(double share) {
  return share > 0.0 ? -share * std::log2(share) : 0.0;
}

// Points beyond this, as a faulty foreign file may hold, share the last bin.
constexpr float kFarthest_m = 1e6F;

/// The whole number of metres, or of metres per second, at or below the value.
std::int64_t CellOf(float value) {
  return static_cast<std::int64_t>(std::floor(std::clamp(value, -kFarthest_m, kFarthest_m)));
}

// One direction: from each point of one cloud to the nearest point of the other.
struct OneWay {
  double mean_m{};
  double mean_square_m2{};
  double largest_m{};
  double p95_m{};
  double density_aware{};
};

// The 95th percentile by nearest rank: the smallest value that 95 % of the distances do not exceed.
double Percentile95_m(std::vector<float> distances_m) {
  constexpr double kShare = 0.95;
  const auto rank =
      static_cast<std::size_t>(std::ceil(kShare * static_cast<double>(distances_m.size())));
  const auto at = distances_m.begin() + static_cast<std::ptrdiff_t>(rank - 1);
  std::nth_element(distances_m.begin(), at, distances_m.end());
  return static_cast<double>(*at);
}

OneWay OneWayOf(const NearestPoints& nearest, std::size_t num_others) {
  std::vector<std::uint32_t> num_sharing(num_others);
  for (const std::uint32_t index : nearest.index) ++num_sharing[index];
  OneWay way;
  for (std::size_t i = 0; i < nearest.index.size(); ++i) {
    const auto distance_m = static_cast<double>(nearest.distance_m[i]);
    way.mean_m += distance_m;
    way.mean_square_m2 += distance_m * distance_m;
    way.largest_m = std::max(way.largest_m, distance_m);
    way.density_aware += 1.0 - std::exp(-kDensityAwareAlpha_per_m * distance_m) /
                                   static_cast<double>(num_sharing[nearest.index[i]]);
  }
  const auto num = static_cast<double>(nearest.index.size());
  way.mean_m /= num;
  way.mean_square_m2 /= num;
  way.density_aware /= num;
  way.p95_m = Percentile95_m(nearest.distance_m);
  return way;
}

double ShareWithin(const NearestPoints& nearest, double distance_m) {
  const auto num = std::count_if(nearest.distance_m.begin(), nearest.distance_m.end(),
                                 [&](float d_m) { return static_cast<double>(d_m) <= distance_m; });
  return static_cast<double>(num) / static_cast<double>(nearest.distance_m.size());
}

constexpr double kPercentOf = 100.0;

double RelativeChangeOf(double from, double to) {
  return (to - from) / from;
}

BinnedCloud EmptyBins() {
  return {std::vector<BinnedCloud::Bin>(RangeBins().size())};
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

double JensenShannonDivergence(const Histogram& a, const Histogram& b) {
  if (a.num() == 0 || b.num() == 0) return std::numeric_limits<double>::quiet_NaN();
  const auto num_a = static_cast<double>(a.num());
  const auto num_b = static_cast<double>(b.num());
  std::map<std::int64_t, std::array<double, 2>> shares;
  for (const auto& [bin, count] : a.counts()) shares[bin][0] = static_cast<double>(count) / num_a;
  for (const auto& [bin, count] : b.counts()) shares[bin][1] = static_cast<double>(count) / num_b;
  double divergence = 0.0;
  for (const auto& [bin, share] : shares) {
    divergence += Bits(0.5 * (share[0] + share[1])) - 0.5 * (Bits(share[0]) + Bits(share[1]));
  }
  return std::clamp(divergence, 0.0, 1.0);
}

CloudHistograms HistogramsOf(const ComparedCloud& cloud) {
  std::vector<std::int64_t> ranges, intensities, velocities, cells;
  for (const float range_m : cloud.range_m) {
    ranges.push_back(static_cast<std::int64_t>(std::min(range_m, kFarthest_m)));
  }
  for (const float intensity : cloud.intensity) {
    if (std::isfinite(intensity))
      intensities.push_back(BinOfIntensity(static_cast<double>(intensity)));
  }
  for (const float velocity_mps : cloud.velocity_mps) {
    if (std::isfinite(velocity_mps)) velocities.push_back(CellOf(velocity_mps));
  }
  for (const Eigen::Vector3f& point_m : cloud.points_m) {
    constexpr std::int64_t kCellsARow = 10'000'000;
    cells.push_back(CellOf(point_m.y()) * kCellsARow + CellOf(point_m.x()));
  }
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  return {Histogram(ranges), Histogram(intensities),
          Histogram(std::vector<std::int64_t>(cloud.rings.begin(), cloud.rings.end())),
          Histogram(velocities), Histogram(cells)};
}

double IntensityOfBin(std::int64_t bin) {
  return std::exp2((static_cast<double>(bin) + 0.5) / kIntensityBinsAnOctave);
}

CloudDistances DistancesOf(const NearestPoints& a_in_b,
                           const NearestPoints& b_in_a,
                           const std::vector<double>& distances_m) {
  const OneWay a = OneWayOf(a_in_b, b_in_a.index.size());
  const OneWay b = OneWayOf(b_in_a, a_in_b.index.size());
  CloudDistances all;
  all.a_to_b_m = a.mean_m;
  all.b_to_a_m = b.mean_m;
  all.chamfer_m = 0.5 * (a.mean_m + b.mean_m);
  all.chamfer_squares_m2 = a.mean_square_m2 + b.mean_square_m2;
  all.hausdorff_m = std::max(a.largest_m, b.largest_m);
  all.hausdorff95_m = std::max(a.p95_m, b.p95_m);
  all.density_aware = 0.5 * (a.density_aware + b.density_aware);
  for (const double distance_m : distances_m) {
    WithinDistance within;
    within.precision = ShareWithin(b_in_a, distance_m);
    within.recall = ShareWithin(a_in_b, distance_m);
    const double sum = within.precision + within.recall;
    within.f_score = sum > 0.0 ? 2.0 * within.precision * within.recall / sum : 0.0;
    all.within.push_back(within);
  }
  return all;
}

std::optional<CloudDistances> DistancesOf(const ComparedCloud& a,
                                          const ComparedCloud& b,
                                          const std::vector<double>& distances_m) {
  if (a.size() == 0 || b.size() == 0) return std::nullopt;
  const NearestSearch in_a(a.points_m), in_b(b.points_m);
  return DistancesOf(in_b.Of(a.points_m), in_a.Of(b.points_m), distances_m);
}

double BinnedCloud::Bin::MeanIntensity() const {
  if (num_intensities < kMinSamples) return std::numeric_limits<double>::quiet_NaN();
  return intensity_sum / static_cast<double>(num_intensities);
}

double BinnedCloud::Bin::MeanVelocity_mps() const {
  if (num_velocities < kMinSamples) return std::numeric_limits<double>::quiet_NaN();
  return velocity_sum_mps / static_cast<double>(num_velocities);
}

BinnedCloud BinnedByRange(const ComparedCloud& cloud) {
  BinnedCloud binned = EmptyBins();
  for (std::size_t i = 0; i < cloud.range_m.size(); ++i) {
    const auto found = RangeBins().Find(static_cast<double>(cloud.range_m[i]));
    if (!found) continue;
    BinnedCloud::Bin& bin = binned.bins[*found];
    ++bin.num_points;
    if (!cloud.intensity.empty() && std::isfinite(cloud.intensity[i])) {
      ++bin.num_intensities;
      bin.intensity_sum += static_cast<double>(cloud.intensity[i]);
    }
    if (!cloud.velocity_mps.empty() && std::isfinite(cloud.velocity_mps[i])) {
      ++bin.num_velocities;
      bin.velocity_sum_mps += static_cast<double>(cloud.velocity_mps[i]);
    }
  }
  return binned;
}

BinErrors ErrorsOf(const BinnedCloud& a, const BinnedCloud& b) {
  Mean points, intensity, velocity_mps;
  for (std::size_t i = 0; i < a.bins.size(); ++i) {
    if (a.bins[i].num_points < kMinSamples) continue;
    points.Add(std::abs(RelativeChangeOf(PointsOf(a.bins[i]), PointsOf(b.bins[i]))));
    intensity.Add(std::abs(RelativeChangeOf(a.bins[i].MeanIntensity(), b.bins[i].MeanIntensity())));
    velocity_mps.Add(std::abs(b.bins[i].MeanVelocity_mps() - a.bins[i].MeanVelocity_mps()));
  }
  return {kPercentOf * points.value(), kPercentOf * intensity.value(), velocity_mps.value()};
}

std::vector<double> DistributionFigures(const CloudHistograms& a,
                                        const CloudHistograms& b,
                                        const BinErrors& errors) {
  return {JensenShannonDivergence(a.range, b.range),
          JensenShannonDivergence(a.intensity, b.intensity),
          JensenShannonDivergence(a.ring, b.ring),
          JensenShannonDivergence(a.velocity, b.velocity),
          JensenShannonDivergence(a.occupancy, b.occupancy),
          errors.points,
          errors.intensity,
          errors.velocity_mps};
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
    const double velocity_a_mps = a.bins[i].MeanVelocity_mps();
    const double velocity_b_mps = b.bins[i].MeanVelocity_mps();
    bin.velocity_a_mps.Add(velocity_a_mps);
    bin.velocity_b_mps.Add(velocity_b_mps);
    bin.velocity_change_mps.Add(velocity_b_mps - velocity_a_mps);
  }
  AddTo(sum_a_.bins, a.bins);
  AddTo(sum_b_.bins, b.bins);
}

}  // namespace railcast
