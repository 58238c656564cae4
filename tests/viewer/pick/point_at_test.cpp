#include "viewer/pick/picks.h"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include "tests/viewer/pick/shown_cloud.h"
#include "viewer/pick/picks.h"

namespace railcast {
namespace {

using Positions = std::vector<float>;
constexpr std::array<int, 2> kSize_px = {800, 600};

// An eye at the origin that looks along x, with y left and z up and a horizontal field of view of
// 90 degrees: at depth d, a metre is 400 / d px anywhere in the picture. It clips at 1 m and 100 m.
Eigen::Matrix4d Eye() {
  constexpr double kNear_m = 1.0;
  constexpr double kFar_m = 100.0;
  Eigen::Matrix4d clip_from_points = Eigen::Matrix4d::Zero();
  clip_from_points(0, 1) = -1.0;
  clip_from_points(1, 2) = 800.0 / 600.0;
  clip_from_points(2, 0) = (kFar_m + kNear_m) / (kFar_m - kNear_m);
  clip_from_points(2, 3) = -2.0 * kFar_m * kNear_m / (kFar_m - kNear_m);
  clip_from_points(3, 0) = 1.0;
  return clip_from_points;
}

std::optional<std::size_t> Click(const Positions& positions_m, double x_px, double y_px) {
  return PointAt(positions_m, Eye(), kSize_px, x_px, y_px);
}

TEST(PointAt, FindsAPointAtThePixelWhereItIsSeen) {
  // At 10 m depth, 2 m to the right are 80 px and 1 m up are 40 px from the middle (400, 300).
  const Positions points = {10, 0, 0, 10, -2, 1};
  EXPECT_EQ(Click(points, 400, 300), 0U);
  EXPECT_EQ(Click(points, 480, 340), 1U);
  EXPECT_EQ(Click(points, 480, 260), std::nullopt);
}

TEST(PointAt, TakesTheOneNearestToTheEyeOfThoseWithinFivePixels) {
  // One point is farther away, exactly at the click; the other is nearer, 4 px to the left.
  EXPECT_EQ(Click({20, 0, 0, 10, 0.1F, 0}, 400, 300), 1U);
  EXPECT_EQ(Click({10, 0.1F, 0, 20, 0, 0}, 400, 300), 0U);
}

TEST(PointAt, TakesTheOneNearestOnTheScreenWithinTwelvePixelsElse) {
  // One point is at 10 m, 8 px to the left; the other is at 5 m, 10 px above.
  const Positions points = {10, 0.2F, 0, 5, 0, 0.125F};
  EXPECT_EQ(Click(points, 400, 300), 0U);
  EXPECT_EQ(Click(points, 400, 302), 1U) << "8 px and 8.2 px";
  EXPECT_EQ(Click({10, 0, 0.29F}, 400, 300), 0U) << "11.6 px";
  EXPECT_EQ(Click({10, 0, 0.31F}, 400, 300), std::nullopt) << "12.4 px";
}

TEST(PointAt, PrefersWhatIsWithinFivePixelsToWhatIsNearerToTheEyeBeside) {
  // One point is off by 4 px at 20 m, the other by 6 px at 10 m.
  EXPECT_EQ(Click({10, 0.15F, 0, 20, 0.2F, 0}, 400, 300), 1U);
}

TEST(PointAt, MeasuresPixelsAlikeInBothDirections) {
  // 10 px to the left and 10 px up are 14.1 px.
  EXPECT_EQ(Click({10, 0.25F, 0.25F}, 400, 300), std::nullopt);
  EXPECT_EQ(Click({10, 0.2F, 0.2F}, 400, 300), 0U) << "11.3 px";
}

TEST(PointAt, NeverTakesWhatIsNotSeen) {
  EXPECT_EQ(Click({-10, 0, 0}, 400, 300), std::nullopt) << "behind the eye";
  EXPECT_EQ(Click({0.99F, 0, 0}, 400, 300), std::nullopt) << "nearer than the clip plane";
  EXPECT_EQ(Click({1.01F, 0, 0}, 400, 300), 0U);
  EXPECT_EQ(Click({101, 0, 0}, 400, 300), std::nullopt) << "beyond the clip plane";
  EXPECT_EQ(Click({10, 10.1F, 0}, 1, 300), std::nullopt) << "4 px beside the picture";
  EXPECT_EQ(Click({10, 9.9F, 0}, 1, 300), 0U) << "4 px inside it";
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(Click({nan, nan, nan, 10, 0, 0}, 400, 300), 1U);
  EXPECT_EQ(Click({}, 400, 300), std::nullopt);
}

TEST(PointAt, WorksWithoutPerspective) {
  // 1 m is 100 px in both directions; x from 0 m to 100 m is visible.
  Eigen::Matrix4d clip_from_points = Eigen::Matrix4d::Zero();
  clip_from_points(0, 1) = -100.0 / 400.0;
  clip_from_points(1, 2) = 100.0 / 300.0;
  clip_from_points(2, 0) = 0.02;
  clip_from_points(2, 3) = -1.0;
  clip_from_points(3, 3) = 1.0;
  const Positions points = {80, -1, 2, 60, -1, 2, 70, 0, 0};
  EXPECT_EQ(PointAt(points, clip_from_points, kSize_px, 500, 500), 1U);
  EXPECT_EQ(PointAt(points, clip_from_points, kSize_px, 409, 300), 2U);
}

// The points are 5 m apart horizontally and 12 m vertically, so 13 m in all.
const std::vector<Vector3> kTwoPoints_m = {{10, 1, -2}, {13, 5, 10}};

RecordedFrame PosedFrame(const std::string& name, const Transform& world_from_sensor) {
  RecordedFrame recorded = RecordedCloud(name, kTwoPoints_m);
  recorded.has_pose = true;
  recorded.frame.world_from_sensor = world_from_sensor;
  return recorded;
}

TEST(DistanceText, SaysTheWayWithinAFrameAlongTheSensorsAxes) {
  const ShownFrame shown = Show(RecordedCloud("a.pcd", kTwoPoints_m));
  EXPECT_EQ(DistanceText(PickOf(shown, 0), PickOf(shown, 1)),
            "13.000 m (dx 3.000, dy 4.000, dz 12.000; level 5.000 m)");
  EXPECT_EQ(DistanceText(PickOf(shown, 1), PickOf(shown, 0)),
            "13.000 m (dx -3.000, dy -4.000, dz -12.000; level 5.000 m)");
  EXPECT_EQ(DistanceText(PickOf(shown, 1), PickOf(shown, 1)),
            "0.000 m (dx 0.000, dy 0.000, dz 0.000; level 0.000 m)");
}

TEST(DistanceText, KnowsAFrameThatWasReadAgain) {
  const ShownFrame before = Show(RecordedCloud("a.pcd", kTwoPoints_m));
  const ShownFrame again = Show(RecordedCloud("a.pcd", kTwoPoints_m));
  EXPECT_EQ(DistanceText(PickOf(before, 0), PickOf(again, 1)),
            "13.000 m (dx 3.000, dy 4.000, dz 12.000; level 5.000 m)");
}

TEST(DistanceText, SaysTheWayBetweenFramesAlongTheWorldsAxes) {
  // The sensor looks north at first; 20 m farther north it looks east.
  const Transform first = MakeTransform(RotationFromYawPitchRoll(std::numbers::pi / 2.0, 0.0, 0.0),
                                        Vector3(5e6, 6e5, 400));
  const Transform second =
      MakeTransform(Eigen::Matrix3d::Identity(), first.translation() + Vector3(0, 20, 0));
  // (10, 1) seen looking north is 1 m west and 10 m north; (13, 5) seen looking east is unchanged.
  EXPECT_EQ(DistanceText(PickOf(Show(PosedFrame("a.pcd", first)), 0),
                         PickOf(Show(PosedFrame("b.pcd", second)), 1)),
            "23.770 m (east 14.000, north 15.000, up 12.000; level 20.518 m)");
}

TEST(DistanceText, IsNothingBetweenFramesWithoutPoses) {
  const ShownFrame bare = Show(RecordedCloud("a.pcd", kTwoPoints_m));
  const ShownFrame posed = Show(PosedFrame("b.pcd", Transform::Identity()));
  EXPECT_EQ(DistanceText(PickOf(bare, 0), PickOf(posed, 1)), std::nullopt);
  EXPECT_EQ(DistanceText(PickOf(posed, 0), PickOf(bare, 1)), std::nullopt);
  EXPECT_EQ(DistanceText(PickOf(bare, 0), PickOf(Show(RecordedCloud("c.pcd", kTwoPoints_m)), 1)),
            std::nullopt);
}

}  // namespace
}  // namespace railcast
