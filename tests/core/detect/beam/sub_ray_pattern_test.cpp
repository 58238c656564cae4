#include "core/detect/beam/sub_ray_pattern.h"

#include <gtest/gtest.h>

#include <algorithm>
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
  for (const SubRayPattern& pattern : {DenseSubRays(16), DenseSubRays(255)}) {
    double sum = static_cast<double>(pattern.central_share);
    for (const SubRay& sub_ray : pattern.sub_rays) sum += static_cast<double>(sub_ray.share);
    EXPECT_NEAR(sum, 1.0, 1e-6 * static_cast<double>(pattern.sub_rays.size() + 1));
  }
}

// A shear instead of a rotation would squeeze the pattern of each beam towards a line, and averages
// over all angles would not show it.
TEST(SubRays, AreTurnedRigidly) {
  constexpr double kFloatStep = 1e-6;  // Rounding of radii up to 4 standard deviations.
  for (const SubRay& sub_ray : DenseSubRays(16).sub_rays) {
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

// For the share of a beam left of a straight edge at every angle and offset: the largest error.
double LargestErrorOfAnEdge(const BeamSubRays& all) {
  double largest = 0.0;
  for (int step = 0; step < 360; ++step) {
    const double angle_rad = std::numbers::pi * step / 180.0;
    for (double edge = -3.0; edge <= 3.0; edge += 0.05) {
      std::size_t num_left = 0;
      for (std::size_t i = 0; i < all.num; ++i) {
        const double across = std::cos(angle_rad) * static_cast<double>(all.h[i]) +
                              std::sin(angle_rad) * static_cast<double>(all.v[i]);
        num_left += across < edge ? 1U : 0U;
      }
      const double share = 0.5 * std::erfc(-edge / std::numbers::sqrt2);
      const double found = static_cast<double>(num_left) / static_cast<double>(all.num);
      largest = std::max(largest, std::fabs(found - share));
    }
  }
  return largest;
}

// Independent rays would have standard deviations of 0.0625 and 0.125.
TEST(SubRays, OfABeamFindTheShareBesideAnEdge) {
  EXPECT_LT(LargestErrorOfAnEdge(SubRaysOfBeam()), 0.075);
  EXPECT_LT(LargestErrorOfAnEdge(SubRaysOfCrowd()), 0.15);
  EXPECT_LT(LargestErrorOfAnEdge(SubRaysOfCloserLook()), 0.02);
}

TEST(SubRays, OfACrowdAreTheFirstOfABeam) {
  const BeamSubRays& beam = SubRaysOfBeam();
  const BeamSubRays& crowd = SubRaysOfCrowd();
  ASSERT_EQ(crowd.num, kNumCrowdedSubRays);
  EXPECT_TRUE(std::equal(crowd.h, crowd.h + crowd.num, beam.h));
  EXPECT_TRUE(std::equal(crowd.v, crowd.v + crowd.num, beam.v));
  EXPECT_LT(crowd.largest_offset, 0.9F * beam.largest_offset);
}

TEST(SubRays, OfABeamHaveThePatternsRadius) {
  const BeamSubRays& all = SubRaysOfBeam();
  double sum2 = 0.0;
  for (std::size_t i = 0; i < kNumSubRays; ++i) {
    const double radius = std::hypot(static_cast<double>(all.h[i]), static_cast<double>(all.v[i]));
    EXPECT_LE(radius, static_cast<double>(all.largest_offset) + 1e-6);
    sum2 += radius * radius;
  }
  // The mean square radius of a Gaussian beam is 2; the outermost cells are cut at their median.
  EXPECT_NEAR(sum2 / kNumSubRays, 2.0, 0.05);
}

// Of a vector of sub-rays, few lie on a small surface unless they are neighbours.
TEST(SubRays, OfAVectorAreNeighbours) {
  constexpr std::size_t kNumInVector = 8;
  const BeamSubRays& all = SubRaysOfBeam();
  for (std::size_t first = 0; first < kNumSubRays; first += kNumInVector) {
    float length = 0.0F;
    for (std::size_t i = first + 1; i < first + kNumInVector; ++i) {
      length += std::hypot(all.h[i] - all.h[i - 1], all.v[i] - all.v[i - 1]);
    }
    // In no order, they would be 1.8 standard deviations apart in the mean.
    EXPECT_LT(length / (kNumInVector - 1), 1.2F) << first;
  }
}

}  // namespace
}  // namespace railcast
