#include "analysis/compare/distances.h"

#include <algorithm>
#include <cmath>

namespace railcast {
namespace {

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

}  // namespace

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
  const NearestSearch in_a(a.points), in_b(b.points);
  return DistancesOf(in_b.Of(*a.points), in_a.Of(*b.points), distances_m);
}

}  // namespace railcast
