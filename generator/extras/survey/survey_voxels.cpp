#include "generator/extras/survey/survey_voxels.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "core/base/error.h"
#include "core/base/text.h"
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

constexpr std::int32_t kMostVoxels = 1 << 20;  // To either side: a key has 21 bits for each axis.

void Count(const SurveyBeam& beam, SurveyVoxel& voxel) {
  if (beam.label == SurveyLabels::kUnknown) return;
  // The majority vote of Boyer and Moore, which needs no table.
  if (voxel.label_lead == 0) voxel.label = beam.label;
  if (beam.label != voxel.label) {
    --voxel.label_lead;
  } else if (voxel.label_lead < 0xFFFF) {
    ++voxel.label_lead;
  }
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

void SurveyVoxels::Add(const SurveyFrame& frame, std::uint32_t frame_index) {
  const std::vector<float> spacings_rad = SpacingsOf_rad(frame);
  for (std::size_t i = 0; i < frame.beams.size(); ++i) {
    const SurveyBeam& beam = frame.beams[i];
    if (voxels_.empty()) origin_m_ = beam.point_m.array().floor();
    const Vector3 cell = ((beam.point_m - origin_m_) / edge_m_).array().floor();
    if (!(cell.array().abs() < kMostVoxels).all()) {
      throw InputError("the survey: must lie within " + ShortText(kMostVoxels * edge_m_) +
                       " m of its first point (got a point " +
                       ShortText((beam.point_m - origin_m_).norm()) + " m from it)");
    }
    const std::array<std::int32_t, 3> place{static_cast<std::int32_t>(cell.x()),
                                            static_cast<std::int32_t>(cell.y()),
                                            static_cast<std::int32_t>(cell.z())};
    std::uint64_t key = 0;
    for (const std::int32_t coordinate : place) {
      key = (key << 21U) | static_cast<std::uint64_t>(coordinate + kMostVoxels);
    }
    const auto [found, is_new] =
        index_of_cell_.try_emplace(key, static_cast<std::uint32_t>(voxels_.size()));
    if (is_new) voxels_.push_back({.cell = place, .first_frame = frame_index});
    SurveyVoxel& voxel = voxels_[found->second];
    voxel.sum_m += (beam.point_m - origin_m_ - edge_m_ * cell).cast<float>();
    ++voxel.num_points;
    if (voxel.num_frames == 0 || voxel.last_frame != frame_index) ++voxel.num_frames;
    voxel.last_frame = frame_index;
    if (std::isfinite(beam.reflectance)) {
      voxel.reflectance_sum += beam.reflectance;
      ++voxel.num_reflectances;
    }
    if (frame.has_origins) {
      const Vector3 back_m = beam.origin_m - beam.point_m;
      voxel.view_sum += back_m.normalized().cast<float>();
      const float spacing_m = spacings_rad[i] * static_cast<float>(back_m.norm());
      voxel.spacing_m = is_new ? spacing_m : std::min(voxel.spacing_m, spacing_m);
    }
    Count(beam, voxel);
  }
}

Vector3 SurveyVoxels::MeanOf(const SurveyVoxel& voxel) const {
  const Vector3 corner_m(voxel.cell[0] * edge_m_, voxel.cell[1] * edge_m_, voxel.cell[2] * edge_m_);
  return origin_m_ + corner_m + voxel.sum_m.cast<double>() / voxel.num_points;
}

}  // namespace railcast
