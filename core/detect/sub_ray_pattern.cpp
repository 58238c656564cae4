#include "core/detect/sub_ray_pattern.h"

#include <cmath>
#include <cstdlib>
#include <numbers>

namespace railcast {
namespace {

// The radius, in standard deviations, that a part of a Gaussian beam lies outside of (Rayleigh's
// distribution).
double RadiusOutsideOf(double share) {
  return std::sqrt(-2.0 * std::log(share));
}

void Add(double radius, double angle_rad, double share, SubRayPattern& pattern) {
  pattern.sub_rays.push_back({static_cast<float>(radius * std::cos(angle_rad)),
                              static_cast<float>(radius * std::sin(angle_rad)),
                              static_cast<float>(share)});
}

int Env(const char* name, int otherwise) {
  const char* text = std::getenv(name);
  return text != nullptr ? std::atoi(text) : otherwise;
}

}  // namespace

SubRayPattern RingSubRays() {
  const int kOuter = Env("RC_OUT", 7);
  const int kMiddle = Env("RC_MID", 5);
  constexpr double kOuterShare = 0.30;
  constexpr double kCentralShare = 0.14;
  constexpr double kMiddleShare = 1.0 - kOuterShare - kCentralShare;
  SubRayPattern pattern;
  pattern.central_share = static_cast<float>(kCentralShare);
  const auto add_ring = [&](int count, double share_outside, double share, double turn) {
    const double radius = RadiusOutsideOf(share_outside + 0.5 * share);
    for (int k = 0; k < count; ++k) {
      Add(radius, 2.0 * std::numbers::pi * (k + turn) / count, share / count, pattern);
    }
  };
  add_ring(kMiddle, kOuterShare, kMiddleShare, 0.0);
  add_ring(kOuter, 0.0, kOuterShare, 0.5);
  return pattern;
}

SubRayPattern DenseSubRays(std::size_t count) {
  const double golden_rad = std::numbers::pi * (3.0 - std::sqrt(5.0));
  const double share = 1.0 / static_cast<double>(count + 1);
  SubRayPattern pattern;
  pattern.central_share = static_cast<float>(share);
  for (std::size_t k = 0; k < count; ++k) {
    // The central ray stands for the innermost part.
    const double share_outside = 1.0 - (static_cast<double>(k) + 1.5) * share;
    Add(RadiusOutsideOf(share_outside), golden_rad * static_cast<double>(k), share, pattern);
  }
  return pattern;
}

}  // namespace railcast
