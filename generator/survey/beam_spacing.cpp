#include "generator/survey/beam_spacing.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "core/points/nearest_points.h"

namespace railcast {
namespace {

using Directions = std::vector<Eigen::Vector3f>;

/// Enough neighbours of an even grid, and of rows that are ten times as far apart as their beams.
constexpr std::array<std::size_t, 2> kNumNeighbors{13, 120};

Directions DirectionsOf(const SurveyFrame& frame) {
  Directions directions;
  directions.reserve(frame.beams.size());
  for (const SurveyBeam& beam : frame.beams) {
    directions.emplace_back((beam.point_m - beam.origin_m).normalized().cast<float>());
  }
  return directions;
}

/// The distance to the nearest neighbour along and across the horizon; infinite where there is
/// none.
std::array<float, 2> NearestAlongAndAcross(const Directions& directions,
                                           std::size_t beam,
                                           const std::vector<std::uint32_t>& neighbors) {
  // Beams of one direction, as two returns of one firing, are no neighbours.
  constexpr float kSame_rad = 2e-4F;
  const Eigen::Vector3f& ahead = directions[beam];
  const Eigen::Vector3f along = Eigen::Vector3f::UnitZ().cross(ahead).normalized();
  const Eigen::Vector3f across = ahead.cross(along);
  std::array<float, 2> nearest_rad{std::numeric_limits<float>::infinity(),
                                   std::numeric_limits<float>::infinity()};
  for (const std::uint32_t neighbor : neighbors) {
    const Eigen::Vector3f offset = directions[neighbor] - ahead;
    const float distance_rad = offset.norm();
    if (distance_rad < kSame_rad) continue;
    float& nearest =
        nearest_rad[std::abs(offset.dot(along)) >= std::abs(offset.dot(across)) ? 0 : 1];
    nearest = std::min(nearest, distance_rad);
  }
  return nearest_rad;
}

}  // namespace

std::vector<float> SpacingsOf_rad(const SurveyFrame& frame) {
  if (!frame.has_origins || frame.beams.empty()) return {};
  const NearestSearch search(DirectionsOf(frame));
  std::vector<float> spacings_rad(frame.beams.size());
  tbb::parallel_for(std::size_t{0}, spacings_rad.size(), [&](std::size_t i) {
    std::vector<std::uint32_t> neighbors;
    for (const std::size_t num : kNumNeighbors) {
      search.FindNearest(search.points_m()[i], num, neighbors);
      const auto [along_rad, across_rad] = NearestAlongAndAcross(search.points_m(), i, neighbors);
      spacings_rad[i] = std::max(along_rad, across_rad);
      if (std::isfinite(spacings_rad[i])) break;
    }
  });
  std::vector<float> sorted_rad = spacings_rad;
  const auto middle = sorted_rad.begin() + std::ssize(sorted_rad) / 2;
  std::nth_element(sorted_rad.begin(), middle, sorted_rad.end());
  const float most_rad = std::isfinite(*middle) ? kMostOfTypical * *middle : 0.0F;
  for (float& spacing_rad : spacings_rad) spacing_rad = std::min(spacing_rad, most_rad);
  return spacings_rad;
}

}  // namespace railcast
