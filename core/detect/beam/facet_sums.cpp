#include "core/detect/beam/facet_parts.h"

#include <cmath>

namespace railcast {
namespace {

// Facets of one surface are one plane if their normals differ by less than 2.5 degrees and the
// centre of one is as close to the plane of the other as this: the roughness of ballast near the
// sensor, float32 rounding, and chords of curved surfaces.
constexpr float kLeastCosine2 = 0.998F;
constexpr float kStep_m = 0.01F;
constexpr float kStepPerRange = 3e-4F;

}  // namespace

void FacetSums::Add(const BeamRays& beam) {
  const std::size_t begin = sums_.size();
  sums_.resize(begin + beam.num_facets, FacetSum{});
  for (std::size_t i = 0; i < beam.num_rays; ++i) {
    FacetSum& sums = sums_[begin + beam.facet[i]];
    if (sums.num++ == 0) {
      sums.facet = beam.facets[beam.facet[i]];
      sums.base_m = beam.range_m[i];
    }
    const float range_m = beam.range_m[i] - sums.base_m;
    sums.range_m += range_m;
    sums.range2_m2 += range_m * range_m;
    sums.x += beam.direction_x[i];
    sums.y += beam.direction_y[i];
    sums.z += beam.direction_z[i];
  }
  std::erase_if(sums_, [](const FacetSum& sums) { return sums.num == 0; });
}

void FacetSums::JoinPlanes(std::size_t most_planes) {
  if (sums_.size() > most_planes) return;
  const auto are_one_plane = [&](const FacetSum& a, const FacetSum& b) {
    const Facet& plane = a.facet;
    const Facet& other = b.facet;
    if (plane.surface != other.surface) return false;
    const float cosine = Dot(plane, other);
    const float length2 = Dot(plane, plane);
    if (cosine * cosine < kLeastCosine2 * length2 * Dot(other, other)) return false;
    const float range_a =
        (a.base_m + a.range_m / static_cast<float>(a.num)) / static_cast<float>(a.num);
    const float range_b =
        (b.base_m + b.range_m / static_cast<float>(b.num)) / static_cast<float>(b.num);
    const float off = plane.normal_x * (range_b * b.x - range_a * a.x) +
                      plane.normal_y * (range_b * b.y - range_a * a.y) +
                      plane.normal_z * (range_b * b.z - range_a * a.z);
    const float step_m = kStep_m + kStepPerRange * a.base_m;
    return off * off <= step_m * step_m * length2;
  };
  for (std::size_t i = 0; i < sums_.size(); ++i) {
    for (std::size_t k = sums_.size(); --k > i;) {
      if (!are_one_plane(sums_[i], sums_[k])) continue;
      FacetSum& a = sums_[i];
      const FacetSum& b = sums_[k];
      const float shift_m = b.base_m - a.base_m;
      const auto num = static_cast<float>(b.num);
      a.range2_m2 += b.range2_m2 + 2.0F * shift_m * b.range_m + num * shift_m * shift_m;
      a.range_m += b.range_m + num * shift_m;
      a.x += b.x;
      a.y += b.y;
      a.z += b.z;
      a.num += b.num;
      sums_.erase(sums_.begin() + static_cast<std::ptrdiff_t>(k));
    }
  }
}

void FacetSums::Remove(std::uint32_t surface) {
  std::erase_if(sums_, [=](const FacetSum& sums) { return sums.facet.surface == surface; });
}

void FacetSums::RemoveOthers(std::uint32_t surface) {
  std::erase_if(sums_, [=](const FacetSum& sums) { return sums.facet.surface != surface; });
}

}  // namespace railcast
