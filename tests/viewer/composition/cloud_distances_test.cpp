#include "viewer/composition/cloud_distances.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "tests/viewer/pick/shown_cloud.h"

namespace railcast {
namespace {

using testing::ElementsAre;
using testing::FloatNear;
using testing::IsEmpty;

ShownFrame Posed(const std::vector<Vector3>& points_m, const Transform& world_from_sensor) {
  RecordedFrame recorded = RecordedCloud("posed.pcd", points_m);
  recorded.has_pose = true;
  recorded.frame.world_from_sensor = world_from_sensor;
  return Show(std::move(recorded));
}

TEST(CloudDistances, GoFromEveryPointToTheNearestOfTheOtherCloud) {
  const ShownFrame of = Show(RecordedCloud("a.pcd", {{0, 0, 0}, {10, 3, 4}, {20, 0, 1}}));
  const ShownFrame other = Show(RecordedCloud("b.pcd", {{20, 0, 0}, {10, 0, 0}, {0, 0, 0}}));
  EXPECT_THAT(DistancesToNearest_m(of, other), ElementsAre(0.0F, 5.0F, 1.0F));
}

TEST(CloudDistances, KnowWhatWasSubtractedFromFarPositions) {
  // The points are at x = 691499 and 691501 m, each stored relative to the kilometre next to it.
  RecordedFrame low = RecordedCloud("a.pcd", {{499, 0, 0}});
  low.origin_m = {691000, 0, 0};
  RecordedFrame high = RecordedCloud("b.pcd", {{-499, 0, 0}});
  high.origin_m = {692000, 0, 0};
  EXPECT_THAT(DistancesToNearest_m(Show(low), Show(high)), ElementsAre(2.0F));
}

TEST(CloudDistances, AreNotTheSameTheOtherWayRound) {
  const ShownFrame one = Show(RecordedCloud("a.pcd", {{0, 0, 0}}));
  const ShownFrame two = Show(RecordedCloud("b.pcd", {{0, 0, 0}, {7, 0, 0}}));
  EXPECT_THAT(DistancesToNearest_m(one, two), ElementsAre(0.0F));
  EXPECT_THAT(DistancesToNearest_m(two, one), ElementsAre(0.0F, 7.0F));
}

TEST(CloudDistances, AreTakenInTheWorldWhereBothHavePoses) {
  // The same two places in the world, 5000 km from its origin, seen by a sensor that looks east
  // and, 20 m farther on, by one that looks north; one of the places is 0.25 m higher for the
  // second.
  const Vector3 origin_m(5e6, 6e5, 400);
  const ShownFrame east =
      Posed({{30, 0, 0}, {30, 5, 0}}, MakeTransform(Eigen::Matrix3d::Identity(), origin_m));
  const ShownFrame north =
      Posed({{5, -10, 0.25}, {0, -10, 0}},
            MakeTransform(RotationFromYawPitchRoll(std::numbers::pi / 2.0, 0.0, 0.0),
                          origin_m + Vector3(20, 0, 0)));
  // A coordinate of 30 m is exact to 2 um as float.
  constexpr float kTolerance_m = 1e-5F;
  EXPECT_THAT(DistancesToNearest_m(east, north),
              ElementsAre(FloatNear(0.0F, kTolerance_m), FloatNear(0.25F, kTolerance_m)));
  EXPECT_THAT(DistancesToNearest_m(north, east),
              ElementsAre(FloatNear(0.25F, kTolerance_m), FloatNear(0.0F, kTolerance_m)));
}

TEST(CloudDistances, AreTakenAsTheCloudsAreWhereOneHasNoPose) {
  const ShownFrame bare = Show(RecordedCloud("a.pcd", {{30, 0, 0}}));
  const ShownFrame posed =
      Posed({{30, 0, 2}}, MakeTransform(Eigen::Matrix3d::Identity(), Vector3(100, 0, 0)));
  EXPECT_FALSE(FirstFromSecond(bare, posed));
  EXPECT_FALSE(FirstFromSecond(posed, bare));
  EXPECT_THAT(DistancesToNearest_m(bare, posed), ElementsAre(2.0F));
}

TEST(CloudDistances, LayTheSecondFrameOverTheFirst) {
  const Transform first = MakeTransform(Eigen::Matrix3d::Identity(), Vector3(100, 0, 0));
  const Transform second =
      MakeTransform(RotationFromYawPitchRoll(std::numbers::pi / 2.0, 0.0, 0.0), Vector3(120, 1, 0));
  const auto first_from_second = FirstFromSecond(Posed({}, first), Posed({}, second));
  ASSERT_TRUE(first_from_second);
  // A point 3 m ahead of the second sensor is 3 m to the left of it in the first one's axes. The
  // rounding of 120 m is 1e-14.
  const Vector3 point_m = *first_from_second * Vector3(3, 0, 0);
  EXPECT_LT((point_m - Vector3(20, 4, 0)).norm(), 1e-12);
}

TEST(CloudDistances, AreNoNumbersWhereNothingIsNear) {
  const ShownFrame none = Show(RecordedCloud("a.pcd", {}));
  const ShownFrame some = Show(RecordedCloud("b.pcd", {{0, 0, 0}, {7, 0, 0}}));
  EXPECT_THAT(DistancesToNearest_m(none, some), IsEmpty());
  EXPECT_THAT(DistancesToNearest_m(none, none), IsEmpty());
  EXPECT_THAT(DistancesToNearest_m(some, none), ElementsAre(testing::IsNan(), testing::IsNan()));
}

}  // namespace
}  // namespace railcast
