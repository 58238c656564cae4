#pragma once

#include <cstddef>
#include <vector>

namespace railcast {

/// A sub-ray's place in a beam of Gaussian profile, and the share of the beam that it represents.
struct SubRay {
  float h{};  ///< Horizontal offset in standard deviations of the profile.
  float v{};  ///< Vertical offset in standard deviations of the profile.
  float share{};
};

/// The sub-ray after a rotation of the pattern about the beam's axis by an angle of which the
/// cosine and the sine are given. The rotation acts on offsets in standard deviations, so that the
/// sub-ray keeps its quantile of the profile.
[[nodiscard]] inline SubRay Turned(const SubRay& sub_ray, float cosine, float sine) {
  return {cosine * sub_ray.h - sine * sub_ray.v, sine * sub_ray.h + cosine * sub_ray.v,
          sub_ray.share};
}

/// The sub-rays of a beam. All shares, including the central one, add up to 1.
struct SubRayPattern {
  std::vector<SubRay> sub_rays;
  float central_share{};  ///< Share of the central ray, which is traced already; 0 = not used.
};

/// A pattern of few sub-rays that miss little: three rings, each at the median radius of the part
/// of the beam that it represents. The outer ring, with 30 % of the beam at 1.95 standard
/// deviations, is so dense that no straight edge that cuts off 5 % of the beam or more passes
/// between its rays.
[[nodiscard]] SubRayPattern RingSubRays();

/// A pattern of `count` sub-rays of equal share: the k-th is at the k-th quantile of the radius,
/// turned by the golden angle from the one before (Vogel 1979).
[[nodiscard]] SubRayPattern DenseSubRays(std::size_t count);

}  // namespace railcast
