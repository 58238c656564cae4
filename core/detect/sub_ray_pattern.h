#pragma once

#include <cstddef>
#include <vector>

namespace railcast {

/// A sub-ray's place in a beam of Gaussian profile, and the share of the beam that it stands for.
struct SubRay {
  float h{};  ///< In standard deviations of the profile, horizontally ...
  float v{};  ///< ... and vertically.
  float share{};
};

/// A beam's sub-rays. All shares add up to 1.
struct SubRayPattern {
  std::vector<SubRay> sub_rays;
  float central_share{};  ///< Of the central ray, which has been traced already; 0 = not used.
};

/// Few sub-rays that miss little: three rings, each at the median radius of the part of the beam
/// that it stands for. The outer ring, of 30 % at 1.95 standard deviations, is so
/// dense that no straight edge which takes 5 % of the beam or more passes between its rays.
[[nodiscard]] SubRayPattern RingSubRays();

/// `count` sub-rays of equal share: the k-th at the k-th quantile of the radius, turned by the
/// golden angle from the one before (Vogel 1979).
[[nodiscard]] SubRayPattern DenseSubRays(std::size_t count);

}  // namespace railcast
