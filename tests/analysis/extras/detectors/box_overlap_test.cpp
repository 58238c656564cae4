#include "analysis/extras/detectors/detection.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace railcast {
namespace {

OrientedBox BoxOfSize(const Vector3& size_m, const Vector3& center_m = Vector3::Zero()) {
  return {MakeTransform(Eigen::Matrix3d::Identity(), center_m), size_m};
}

TEST(BoxOverlap, IsTheShareOfTheSmallerBox) {
  const OrientedBox wagon = BoxOfSize({20.0, 3.0, 4.0});
  EXPECT_EQ(OverlapOf(wagon, wagon), 1.0);
  // The face that a sensor sees of a wagon is all in it, whatever share of the wagon that is.
  const OrientedBox face = BoxOfSize({0.2, 3.0, 4.0}, {-9.9, 0.0, 0.0});
  EXPECT_EQ(OverlapOf(face, wagon), 1.0);
  EXPECT_EQ(OverlapOf(wagon, face), 1.0);
}

TEST(BoxOverlap, FallsAsBoxesPart) {
  const Vector3 size_m(2.0, 1.0, 4.0);
  const OrientedBox box = BoxOfSize(size_m);
  EXPECT_EQ(OverlapOf(box, BoxOfSize(size_m, {1.0, 0.0, 0.0})), 0.5);
  EXPECT_EQ(OverlapOf(box, BoxOfSize(size_m, {0.5, 0.0, 0.0})), 0.75);
  EXPECT_EQ(OverlapOf(box, BoxOfSize(size_m, {1.0, 0.5, 0.0})), 0.25);
  EXPECT_EQ(OverlapOf(box, BoxOfSize(size_m, {0.0, 0.0, 4.0})), 0.0) << "touching";
  EXPECT_EQ(OverlapOf(box, BoxOfSize(size_m, {50.0, 0.0, 0.0})), 0.0);
}

// Two unit squares turned by 45 degrees share an octagon of 2 (sqrt(2) - 1).
TEST(BoxOverlap, KnowsTurnedBoxes) {
  const OrientedBox box = BoxOfSize({1.0, 1.0, 1.0});
  OrientedBox turned = box;
  turned.world_from_box.rotate(Eigen::AngleAxisd(std::numbers::pi / 4.0, Vector3::UnitZ()));
  // Four faces cut it, each exact to 1/32 of where it cuts.
  EXPECT_NEAR(OverlapOf(box, turned), 2.0 * (std::sqrt(2.0) - 1.0), 0.02);
  OrientedBox upright = box;
  upright.world_from_box.rotate(Eigen::AngleAxisd(std::numbers::pi / 2.0, Vector3::UnitX()));
  EXPECT_EQ(OverlapOf(box, upright), 1.0);
}

TEST(BoxOverlap, DoesNotDependOnWhereBothAre) {
  const Transform far =
      MakeTransform(RotationFromYawPitchRoll(0.7, 0.1, -0.2), Vector3(-2e3, 1e3, 600.0));
  const OrientedBox box = BoxOfSize({2.0, 1.0, 4.0});
  const OrientedBox other = BoxOfSize({2.0, 1.0, 4.0}, {0.45, 0.0, 0.0});
  EXPECT_EQ(
      OverlapOf({far * box.world_from_box, box.size_m}, {far * other.world_from_box, other.size_m}),
      OverlapOf(box, other));
}

TEST(BoxOverlap, OfAGrownBoxIncludesWhatIsBesideIt) {
  const OrientedBox cube = BoxOfSize({0.3, 0.3, 0.3});
  const OrientedBox beside = BoxOfSize({0.1, 0.1, 0.1}, {0.0, 0.3, 0.0});
  EXPECT_EQ(OverlapOf(cube, beside), 0.0);
  EXPECT_EQ(OverlapOf(Grown(cube, 0.3), beside), 1.0);
  EXPECT_TRUE(IsInside(Grown(cube, 0.3), Vector3(0.0, 0.44, -0.44)));
  EXPECT_FALSE(IsInside(Grown(cube, 0.3), Vector3(0.0, 0.46, 0.0)));
}

}  // namespace
}  // namespace railcast
