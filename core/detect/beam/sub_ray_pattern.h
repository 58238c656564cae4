#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/detect/base/effect_parameters.h"
#include "railcast/ray_caster.h"

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

/// A pattern of `count` sub-rays and the central ray, of equal share: the k-th is at the k-th
/// quantile of the radius, turned by the golden angle from the one before (Vogel 1979).
[[nodiscard]] SubRayPattern DenseSubRays(std::size_t count);

/// The offsets of sub-rays of equal share, in standard deviations of the profile. Neighbours stand
/// one after another.
struct BeamSubRays {
  std::size_t num{};
  float h[kNumCloserSubRays], v[kNumCloserSubRays];
  float largest_offset{};  ///< From the axis.
};

/// kNumSubRays sub-rays. The first kNumCrowdedSubRays are a pattern of Vogel's kind by themselves,
/// and so are the others.
[[nodiscard]] const BeamSubRays& SubRaysOfBeam();
/// The first kNumCrowdedSubRays of them.
[[nodiscard]] const BeamSubRays& SubRaysOfCrowd();
/// kNumCloserSubRays sub-rays: one pattern of Vogel's kind.
[[nodiscard]] const BeamSubRays& SubRaysOfCloserLook();

/// How the kernel aim_sub_rays aims them for the firing in a lane, whose pattern is turned.
[[nodiscard]] SubRayAim AimOfFiring(const BeamSubRays& pattern,
                                    const PatternTurns& turns,
                                    std::size_t lane);

}  // namespace railcast
