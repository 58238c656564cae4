#include "generator/survey/survey_voxels.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/text.h"
#include "generator/survey/beam_spacing.h"

namespace railcast {
namespace {

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
