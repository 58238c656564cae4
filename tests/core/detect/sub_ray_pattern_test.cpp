#include "core/detect/sub_ray_pattern.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace railcast {
namespace {

double RadiusOf(const SubRay& sub_ray) {
  return std::hypot(static_cast<double>(sub_ray.h), static_cast<double>(sub_ray.v));
}

double AngleOf(const SubRay& sub_ray) {
  return std::atan2(static_cast<double>(sub_ray.v), static_cast<double>(sub_ray.h));
}

SubRay TurnedBy(const SubRay& sub_ray, double turn_rad) {
  return Turned(sub_ray, static_cast<float>(std::cos(turn_rad)),
                static_cast<float>(std::sin(turn_rad)));
}

TEST(SubRays, HaveSharesThatAddUpToOne) {
  for (const SubRayPattern& pattern : {RingSubRays(), DenseSubRays(16), DenseSubRays(255)}) {
    double sum = static_cast<double>(pattern.central_share);
    for (const SubRay& sub_ray : pattern.sub_rays) sum += static_cast<double>(sub_ray.share);
    EXPECT_NEAR(sum, 1.0, 1e-6 * static_cast<double>(pattern.sub_rays.size() + 1));
  }
}

// A shear instead of a rotation would squeeze the pattern of each beam towards a line, and averages
// over all angles would not show it.
TEST(SubRays, AreTurnedRigidly) {
  constexpr double kFloatStep = 1e-6;  // Rounding of radii up to 4 standard deviations.
  for (const SubRay& sub_ray : RingSubRays().sub_rays) {
    for (int step = 0; step < 16; ++step) {
      const double turn_rad = 2.0 * std::numbers::pi * step / 16.0;
      const SubRay turned = TurnedBy(sub_ray, turn_rad);
      EXPECT_NEAR(RadiusOf(turned), RadiusOf(sub_ray), kFloatStep);
      EXPECT_NEAR(
          std::remainder(AngleOf(turned) - AngleOf(sub_ray) - turn_rad, 2.0 * std::numbers::pi),
          0.0, kFloatStep);
      EXPECT_EQ(turned.share, sub_ray.share);
    }
  }
}

}  // namespace
}  // namespace railcast
