#include "core/camera/lens.h"

#include <gtest/gtest.h>

#include "tests/core/camera/seen.h"

namespace railcast {
namespace {

// What two evaluations of one formula may differ by, at thousands of pixels.
constexpr double kRounding_px = 1e-8;

CameraSpec Distorted(const DistortionSpec& distortion) {
  return {.width_px = 1280, .height_px = 960, .horizontal_fov_deg = 80, .distortion = distortion};
}

const DistortionSpec kBarrel{-0.28, 0.09, 0.0012, -0.0008, -0.011};
const DistortionSpec kPincushion{0.11, 0.02, -0.001, 0.0015, 0.004};

TEST(Lens, HasTheFieldOfViewFromEdgeToEdge) {
  const CameraSpec spec{.width_px = 1920, .height_px = 1080, .horizontal_fov_deg = 60};
  const Lens lens(spec);
  const double edge = std::tan(std::acos(-1.0) / 6.0);
  EXPECT_NEAR(lens.DirectionAt(-0.5, 539.5)->x(), -edge, 1e-12);
  EXPECT_NEAR(lens.DirectionAt(1919.5, 539.5)->x(), edge, 1e-12);
  EXPECT_NEAR(lens.DirectionAt(959.5, 539.5)->norm(), 0.0, 1e-12);
  // Pixels are square.
  EXPECT_NEAR(lens.DirectionAt(0, 1079.5)->y(), edge * 1080 / 1920, 1e-12);
}

TEST(Lens, SeesPointsWhereOpenCvDoes) {
  for (const DistortionSpec& distortion : {DistortionSpec{}, kBarrel, kPincushion}) {
    const CameraSpec spec = Distorted(distortion);
    const Lens lens(spec);
    for (const Vector3& point : {Vector3(0, 0, 1), Vector3(1.5, 0.7, 3), Vector3(-4, 2, 6.5)}) {
      EXPECT_NEAR((lens.Project(point) - SeenAt(spec, point)).norm(), 0.0, kRounding_px);
    }
  }
}

TEST(Lens, LooksFromEachPixelToWhatIsSeenThere) {
  for (const DistortionSpec& distortion : {DistortionSpec{}, kBarrel, kPincushion}) {
    const CameraSpec spec = Distorted(distortion);
    ASSERT_TRUE(IsInvertible(spec));
    const Lens lens(spec);
    for (double v = 0; v < 960; v += 53) {
      for (double u = 0; u < 1280; u += 53) {
        const auto direction = lens.DirectionAt(u, v);
        ASSERT_TRUE(direction);
        const Eigen::Vector2d seen = SeenAt(spec, {direction->x(), direction->y(), 1.0});
        EXPECT_NEAR((seen - Eigen::Vector2d(u, v)).norm(), 0.0, kRounding_px);
      }
    }
  }
}

// Newton's method with full steps fails at single pixels of these, between those at which it does
// not.
TEST(Lens, LooksFromEveryPixelOfAStronglyDistortedImage) {
  const DistortionSpec bulge{
      .k1 = 0.07290808313923929, .k2 = 0.10442730907766491, .k3 = -0.03009446520991182};
  const DistortionSpec oblique{.k1 = -2.030788525242204,
                               .k2 = 2.80237634311493,
                               .p2 = 0.1996657507758857,
                               .k3 = 3.571066935680261};
  for (const DistortionSpec& distortion : {bulge, oblique}) {
    const CameraSpec spec{
        .width_px = 320, .height_px = 240, .horizontal_fov_deg = 110, .distortion = distortion};
    ASSERT_TRUE(IsInvertible(spec));
    const Lens lens(spec);
    for (std::uint32_t v = 0; v < spec.height_px; ++v) {
      for (std::uint32_t u = 0; u < spec.width_px; ++u) {
        const auto direction = lens.DirectionAt(u, v);
        ASSERT_TRUE(direction) << u << ", " << v;
        const Eigen::Vector2d seen = SeenAt(spec, {direction->x(), direction->y(), 1.0});
        ASSERT_NEAR((seen - Eigen::Vector2d(u, v)).norm(), 0.0, 1e-9) << u << ", " << v;
      }
    }
  }
}

TEST(Lens, IsNotInvertibleWhereTwoDirectionsFallTogether) {
  // x (1 - 0.5 x^2) has its largest value, 0.54, at x = 0.82, that is at a field of view of 57
  // degrees without distortion.
  CameraSpec spec = Distorted({.k1 = -0.5});
  spec.height_px = 1;
  spec.horizontal_fov_deg = 56;
  EXPECT_TRUE(IsInvertible(spec));
  spec.horizontal_fov_deg = 58;
  EXPECT_FALSE(IsInvertible(spec));
}

TEST(CameraName, CanBeAFolder) {
  for (const char* good : {"camera", "front_2", "0"}) EXPECT_TRUE(IsCameraName(good)) << good;
  for (const char* bad : {"", "..", "a/b", "Front", "a b", "caf\xC3\xA9"}) {
    EXPECT_FALSE(IsCameraName(bad)) << bad;
  }
  EXPECT_TRUE(IsCameraName(std::string(64, 'a')));
  EXPECT_FALSE(IsCameraName(std::string(65, 'a')));
}

}  // namespace
}  // namespace railcast
