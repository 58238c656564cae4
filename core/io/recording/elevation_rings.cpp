#include "core/io/recording/elevation_rings.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/median.h"
#include "core/base/units.h"

namespace railcast {
namespace {

constexpr double kMinShare = 0.98;
constexpr std::size_t kMinClusterPoints = 8;
/// Clusters with a smaller share of all points than this are strays.
constexpr double kMinClusterShare = 2e-4;

struct Cluster {
  double low_rad{};
  double high_rad{};
  std::size_t num_points{};

  [[nodiscard]] double middle_rad() const { return 0.5 * (low_rad + high_rad); }
};

/// Splits the elevations at gaps wider than `gap_rad` and drops the clusters of strays.
std::vector<Cluster> ClustersOf(std::span<const double> sorted_rad, double gap_rad) {
  const auto min_points =
      std::max(kMinClusterPoints,
               static_cast<std::size_t>(kMinClusterShare * static_cast<double>(sorted_rad.size())));
  std::vector<Cluster> clusters;
  std::size_t begin = 0;
  for (std::size_t i = 1; i <= sorted_rad.size(); ++i) {
    if (i < sorted_rad.size() && sorted_rad[i] - sorted_rad[i - 1] <= gap_rad) continue;
    if (i - begin >= min_points)
      clusters.push_back({sorted_rad[begin], sorted_rad[i - 1], i - begin});
    begin = i;
  }
  return clusters;
}

bool AreRings(const std::vector<Cluster>& clusters, std::size_t num_points) {
  if (clusters.size() < 2 || clusters.size() > kMaxRings) return false;
  std::size_t num_inside = 0;
  for (std::size_t i = 0; i < clusters.size(); ++i) {
    const Cluster& cluster = clusters[i];
    num_inside += cluster.num_points;
    const double width_rad = cluster.high_rad - cluster.low_rad;
    const auto is_near = [&](const Cluster& other) {
      return width_rad > 0.5 * std::abs(other.middle_rad() - cluster.middle_rad());
    };
    if (i > 0 && is_near(clusters[i - 1])) return false;
    if (i + 1 < clusters.size() && is_near(clusters[i + 1])) return false;
  }
  return static_cast<double>(num_inside) >= kMinShare * static_cast<double>(num_points);
}

std::uint32_t NearestOf(const std::vector<Cluster>& clusters, double elevation_rad) {
  const auto above = std::ranges::lower_bound(clusters, elevation_rad, {}, &Cluster::high_rad);
  if (above == clusters.begin()) return 0;
  const auto index = static_cast<std::uint32_t>(above - clusters.begin());
  if (above == clusters.end()) return index - 1;
  const Cluster& below = *(above - 1);
  return elevation_rad - below.high_rad < above->low_rad - elevation_rad ? index - 1 : index;
}

/// Says how crowded the elevations of points are from an origin: the sum of the squared numbers of
/// points in bins.
class Crowding {
 public:
  Crowding(std::span<const LevelPoint> points, double bin_rad)
      : points_(points), bin_rad_(bin_rad) {}

  [[nodiscard]] std::uint64_t From(const std::array<double, 2>& origin_m) {
    bins_.clear();
    for (const LevelPoint& point : points_) {
      bins_.push_back(BinOf(point.ElevationFrom_rad(origin_m)));
    }
    // There are far more bins than points, of which a sensor's elevations take few.
    const auto [least, most] = std::ranges::minmax(bins_);
    num_.resize(std::max(num_.size(), most - least + 1));
    std::uint64_t squares = 0;
    for (const std::size_t bin : bins_) squares += 2 * std::uint64_t{num_[bin - least]++} + 1;
    for (const std::size_t bin : bins_) num_[bin - least] = 0;
    return squares;
  }

 private:
  [[nodiscard]] std::size_t BinOf(double elevation_rad) const {
    return static_cast<std::size_t>((elevation_rad + std::numbers::pi) / bin_rad_);
  }

  std::span<const LevelPoint> points_;
  double bin_rad_;
  std::vector<std::uint32_t> num_;
  std::vector<std::size_t> bins_;
};

/// Searches origins in ever smaller steps, each with bins as wide as a step shifts a near point.
/// Where most points are far, they show no origin: as in a map, or far from 0 in a grid.
std::array<double, 2> MostCrowdedFrom(std::span<const LevelPoint> points) {
  constexpr std::size_t kMostPoints = 12'000;
  constexpr double kFarthest_m = 100.0;
  std::vector<LevelPoint> far;
  for (std::size_t i = 0; i < points.size(); i += 1 + points.size() / kMostPoints) {
    far.push_back(points[i]);
  }
  const auto nearest = far.begin() + static_cast<std::ptrdiff_t>(far.size() * 3 / 5);
  std::ranges::nth_element(far, nearest, {}, &LevelPoint::from_axis_m);
  const double nearest_m = std::max(nearest->from_axis_m, 0.5);
  if (nearest_m > kFarthest_m) return {};
  far.erase(far.begin(), nearest);
  std::array<double, 2> origin_m{};
  std::array<int, 2> num_steps{5, 30};
  for (double step_m = 0.01; step_m > 5e-5; step_m /= 2.5) {
    Crowding crowding(far, 0.5 * step_m / nearest_m);
    const std::array<double, 2> middle_m = origin_m;
    // An origin beside the axis shifts elevations less than one above it.
    const std::array steps_m{2.0 * step_m, step_m};
    std::uint64_t most = 0;
    for (int outwards = -num_steps[0]; outwards <= num_steps[0]; ++outwards) {
      for (int up = -num_steps[1]; up <= num_steps[1]; ++up) {
        const std::array tried_m{middle_m[0] + outwards * steps_m[0],
                                 middle_m[1] + up * steps_m[1]};
        const std::uint64_t squares = crowding.From(tried_m);
        if (squares <= most) continue;
        most = squares;
        origin_m = tried_m;
      }
    }
    num_steps = {4, 4};
  }
  return origin_m;
}

std::vector<double> ElevationsFrom(const std::array<double, 2>& origin_m,
                                   std::span<const LevelPoint> points) {
  std::vector<double> elevations_rad;
  elevations_rad.reserve(points.size());
  for (const LevelPoint& point : points) {
    elevations_rad.push_back(point.ElevationFrom_rad(origin_m));
  }
  return elevations_rad;
}

/// The median of the elevations of each ring; NaN of one without points.
std::vector<double> MiddlesOf(std::span<const double> elevations_rad,
                              std::span<const std::uint32_t> rings) {
  std::vector<std::vector<double>> by_ring(std::ranges::max(rings) + std::size_t{1});
  for (std::size_t i = 0; i < rings.size(); ++i) by_ring[rings[i]].push_back(elevations_rad[i]);
  std::vector<double> middles;
  for (auto& values : by_ring) middles.push_back(MedianOf(values));
  return middles;
}

/// A step of least squares: by how much to move the origin, and the standard deviation of that.
struct OriginStep {
  Eigen::Vector2d by_m = Eigen::Vector2d::Zero();
  Eigen::Vector2d sigma_m = Eigen::Vector2d::Zero();
};

/// The sums of a ring's points: residuals and their derivatives by the origin.
struct RingSums {
  double num{}, residual{};
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();
};

OriginStep StepOf(std::span<const LevelPoint> points,
                  std::span<const std::uint32_t> rings,
                  const std::array<double, 2>& origin_m) {
  const std::vector<double> elevations_rad = ElevationsFrom(origin_m, points);
  const std::vector<double> middles = MiddlesOf(elevations_rad, rings);
  std::vector<double> off_rad, sizes_rad;
  for (std::size_t i = 0; i < points.size(); ++i) {
    off_rad.push_back(elevations_rad[i] - middles[rings[i]]);
    sizes_rad.push_back(std::abs(off_rad.back()));
  }
  // Strays, which are up to 2 % of the points, are left out.
  const auto most = sizes_rad.begin() + static_cast<std::ptrdiff_t>(sizes_rad.size() * 95 / 100);
  std::ranges::nth_element(sizes_rad, most);
  const auto slope_of = [&](std::size_t i) -> Eigen::Vector2d {
    const double out_m = points[i].from_axis_m - origin_m[0];
    const double up_m = points[i].up_m - origin_m[1];
    return Eigen::Vector2d(up_m, -out_m) / (out_m * out_m + up_m * up_m);
  };
  std::vector<RingSums> sums(middles.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (std::abs(off_rad[i]) > *most) continue;
    RingSums& ring = sums[rings[i]];
    ring.num += 1.0;
    ring.residual += off_rad[i];
    ring.slope += slope_of(i);
  }
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  double squares = 0.0;
  double num = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (std::abs(off_rad[i]) > *most) continue;
    const RingSums& ring = sums[rings[i]];
    const Eigen::Vector2d slope = slope_of(i) - ring.slope / ring.num;
    const double off = off_rad[i] - ring.residual / ring.num;
    normal += slope * slope.transpose();
    right -= slope * off;
    squares += off * off;
    num += 1.0;
  }
  const Eigen::Matrix2d inverse = normal.inverse();
  if (!inverse.allFinite()) return {};
  return {inverse * right, (inverse.diagonal() * squares / num).cwiseSqrt()};
}

}  // namespace

double LevelPoint::ElevationFrom_rad(const std::array<double, 2>& origin_m) const {
  return std::atan2(up_m - origin_m[1], from_axis_m - origin_m[0]);
}

std::optional<std::vector<std::uint32_t>> RingsByElevation(std::span<const double> elevations_rad) {
  std::vector<double> sorted_rad(elevations_rad.begin(), elevations_rad.end());
  std::ranges::sort(sorted_rad);
  // The gaps range from the float32 rounding of exact elevations to that of millimetres at 1 m.
  for (const double gap_deg : {0.005, 0.02, 0.05, 0.1}) {
    const std::vector<Cluster> clusters = ClustersOf(sorted_rad, RadFromDeg(gap_deg));
    if (!AreRings(clusters, sorted_rad.size())) continue;
    std::vector<std::uint32_t> rings;
    rings.reserve(elevations_rad.size());
    for (const double elevation_rad : elevations_rad) {
      rings.push_back(NearestOf(clusters, elevation_rad));
    }
    return rings;
  }
  return std::nullopt;
}

std::optional<FoundRings> FindRings(std::span<const LevelPoint> points) {
  if (auto rings = RingsByElevation(ElevationsFrom({}, points))) return FoundRings{*rings, {}};
  const std::array<double, 2> origin_m = MostCrowdedFrom(points);
  auto rings = RingsByElevation(ElevationsFrom(origin_m, points));
  if (!rings) return std::nullopt;
  return FoundRings{std::move(*rings), origin_m};
}

std::array<double, 2> OriginOfRings(std::span<const LevelPoint> points,
                                    std::span<const std::uint32_t> rings) {
  constexpr int kPasses = 8;
  constexpr double kLeast_m = 1e-3;
  constexpr double kLeast_sigmas = 5.0;
  std::array<double, 2> origin_m{};
  OriginStep step;
  for (int pass = 0; pass < kPasses; ++pass) {
    step = StepOf(points, rings, origin_m);
    origin_m[0] += step.by_m.x();
    origin_m[1] += step.by_m.y();
  }
  const auto is_shown = [&](int i) {
    const double away_m = std::abs(origin_m[static_cast<std::size_t>(i)]);
    return away_m > kLeast_m && away_m > kLeast_sigmas * step.sigma_m[i];
  };
  // What one part shows says nothing of the other.
  return {is_shown(0) ? origin_m[0] : 0.0, is_shown(1) ? origin_m[1] : 0.0};
}

}  // namespace railcast
