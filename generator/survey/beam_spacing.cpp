#include "generator/survey/beam_spacing.h"

#include <pcl/kdtree/kdtree_flann.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace railcast {
namespace {

using Directions = pcl::PointCloud<pcl::PointXYZ>;

/// Enough neighbours of an even grid, and of rows that are ten times as far apart as their beams.
constexpr std::array<int, 2> kNumNeighbors{13, 120};

Directions::Ptr DirectionsOf(const SurveyFrame& frame) {
  const Directions::Ptr directions(new Directions);
  directions->reserve(frame.beams.size());
  for (const SurveyBeam& beam : frame.beams) {
    const Eigen::Vector3f ahead = (beam.point_m - beam.origin_m).normalized().cast<float>();
    directions->emplace_back(ahead.x(), ahead.y(), ahead.z());
  }
  return directions;
}

/// The distance to the nearest neighbour along and across the horizon; infinite where there is
/// none.
std::array<float, 2> NearestAlongAndAcross(const Directions& directions,
                                           std::size_t beam,
                                           const pcl::Indices& neighbors) {
  // Beams of one direction, as two returns of one firing, are no neighbours.
  constexpr float kSame_rad = 2e-4F;
  const Eigen::Vector3f ahead = directions[beam].getVector3fMap();
  const Eigen::Vector3f along = Eigen::Vector3f::UnitZ().cross(ahead).normalized();
  const Eigen::Vector3f across = ahead.cross(along);
  std::array<float, 2> nearest_rad{std::numeric_limits<float>::infinity(),
                                   std::numeric_limits<float>::infinity()};
  for (const int neighbor : neighbors) {
    const Eigen::Vector3f offset =
        directions[static_cast<std::size_t>(neighbor)].getVector3fMap() - ahead;
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
  const Directions::Ptr directions = DirectionsOf(frame);
  pcl::KdTreeFLANN<pcl::PointXYZ> tree;
  tree.setInputCloud(directions);
  std::vector<float> spacings_rad(frame.beams.size());
  tbb::parallel_for(std::size_t{0}, spacings_rad.size(), [&](std::size_t i) {
    pcl::Indices neighbors;
    std::vector<float> squared;
    for (const int num : kNumNeighbors) {
      tree.nearestKSearch(static_cast<int>(i), num, neighbors, squared);
      const auto [along_rad, across_rad] = NearestAlongAndAcross(*directions, i, neighbors);
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
