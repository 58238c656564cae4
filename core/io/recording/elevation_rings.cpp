#include "core/io/recording/ring_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "core/base/units.h"

namespace railcast {
namespace {

constexpr double kMinShare = 0.98;
constexpr std::size_t kMinClusterPoints = 8;
/// Clusters with a smaller share of all points than this are strays.
constexpr double kMinClusterShare = 1e-3;

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

}  // namespace

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

}  // namespace railcast
