#include "viewer/pick/picks.h"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/viewer/pick/shown_cloud.h"

namespace railcast {
namespace {

// The points are 5 m apart horizontally and 12 m vertically, so 13 m in all.
const std::vector<Vector3> two_points_m = {{10, 1, -2}, {13, 5, 10}};

RecordedFrame PosedFrame(const std::string& name, const Transform& world_from_sensor) {
  RecordedFrame recorded = RecordedCloud(name, two_points_m);
  recorded.has_pose = true;
  recorded.frame.world_from_sensor = world_from_sensor;
  return recorded;
}

TEST(DistanceText, SaysTheWayWithinAFrameAlongTheSensorsAxes) {
  const ShownFrame shown = Show(RecordedCloud("a.pcd", two_points_m));
  EXPECT_EQ(DistanceText(PickOf(shown, 0), PickOf(shown, 1)),
            "13.000 m (dx 3.000, dy 4.000, dz 12.000; level 5.000 m)");
  EXPECT_EQ(DistanceText(PickOf(shown, 1), PickOf(shown, 0)),
            "13.000 m (dx -3.000, dy -4.000, dz -12.000; level 5.000 m)");
  EXPECT_EQ(DistanceText(PickOf(shown, 1), PickOf(shown, 1)),
            "0.000 m (dx 0.000, dy 0.000, dz 0.000; level 0.000 m)");
}

TEST(DistanceText, KnowsAFrameThatWasReadAgain) {
  const ShownFrame before = Show(RecordedCloud("a.pcd", two_points_m));
  const ShownFrame again = Show(RecordedCloud("a.pcd", two_points_m));
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
  const ShownFrame bare = Show(RecordedCloud("a.pcd", two_points_m));
  const ShownFrame posed = Show(PosedFrame("b.pcd", Transform::Identity()));
  EXPECT_EQ(DistanceText(PickOf(bare, 0), PickOf(posed, 1)), std::nullopt);
  EXPECT_EQ(DistanceText(PickOf(posed, 0), PickOf(bare, 1)), std::nullopt);
  EXPECT_EQ(DistanceText(PickOf(bare, 0), PickOf(Show(RecordedCloud("c.pcd", two_points_m)), 1)),
            std::nullopt);
}

}  // namespace
}  // namespace railcast
