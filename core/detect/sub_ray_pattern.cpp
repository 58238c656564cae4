#include "core/detect/sub_ray_pattern.h"

#include <cmath>
#include <numbers>

namespace railcast {
namespace {

// The radius, in standard deviations, outside of which this share of a Gaussian beam lies (Rayleigh
// distribution).
double RadiusOutsideOf(double share) {
  return std::sqrt(-2.0 * std::log(share));
}

void Add(double radius, double angle_rad, double share, SubRayPattern& pattern) {
  pattern.sub_rays.push_back({static_cast<float>(radius * std::cos(angle_rad)),
                              static_cast<float>(radius * std::sin(angle_rad)),
                              static_cast<float>(share)});
}

}  // namespace

SubRayPattern RingSubRays() {
  // 16 sub-rays in all: one packet of rays, and the number of components that are summed at a time.
  struct Ring {
    int count;
    double share;
  };
  constexpr Ring kRings[] = {{8, 0.30}, {6, 0.56}, {2, 0.14}};
  SubRayPattern pattern;
  double share_outside = 0.0;
  double turn = 0.0;  // In angular steps of a ring; half a step per ring staggers the rays.
  for (const Ring& ring : kRings) {
    const double radius = RadiusOutsideOf(share_outside + 0.5 * ring.share);
    for (int k = 0; k < ring.count; ++k) {
      Add(radius, 2.0 * std::numbers::pi * (k + turn) / ring.count, ring.share / ring.count,
          pattern);
    }
    share_outside += ring.share;
    turn += 0.5;
  }
  return pattern;
}

SubRayPattern DenseSubRays(std::size_t count) {
  const double golden_rad = std::numbers::pi * (3.0 - std::sqrt(5.0));
  const double share = 1.0 / static_cast<double>(count + 1);
  SubRayPattern pattern;
  pattern.central_share = static_cast<float>(share);
  for (std::size_t k = 0; k < count; ++k) {
    // The central ray represents the innermost part, so that the k-th part follows it.
    const double share_outside = 1.0 - (static_cast<double>(k) + 1.5) * share;
    Add(RadiusOutsideOf(share_outside), golden_rad * static_cast<double>(k), share, pattern);
  }
  return pattern;
}

}  // namespace railcast
