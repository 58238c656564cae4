#include "viewer/composition/composer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "tests/viewer/composition/shared_clouds.h"
#include "tests/viewer/pick/shown_cloud.h"

namespace railcast {
namespace {

using testing::Each;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

/// The points are so far apart that, after the shifts in these tests, each is still nearest to
/// itself.
const std::vector<Vector3> kSparseWorld_m = {{100, 0, 0}, {110, 0, 0}, {100, 10, 0}, {100, 0, 20}};

TEST(ComposeDistances, LaysTheSecondWhereItWasInTheFirstsAxes) {
  const Transform first = MakeTransform(RotationFromYawPitchRoll(0.3, 0.0, 0.0), {60, 0, 0});
  const Transform second = MakeTransform(RotationFromYawPitchRoll(-1.2, 0.1, 0.0), {90, 5, 1});
  const auto a = Posed(kSparseWorld_m, first);
  const auto b = Posed(kSparseWorld_m, second);
  Choices choices{.distance_ends_m = {{0.0, 1.0}}};
  const Composition composition = ComposeDistances(a, b, choices);
  ASSERT_THAT(composition.clouds, SizeIs(2));
  EXPECT_EQ(composition.clouds[0].shown, a);
  EXPECT_EQ(composition.clouds[1].shown, b);
  EXPECT_TRUE(composition.clouds[0].view_from_sensor.isApprox(Transform::Identity(), 0.0));
  // Rounding of products of doubles of some 100 m.
  EXPECT_TRUE(composition.clouds[1].view_from_sensor.isApprox(first.inverse() * second, 1e-13));
  EXPECT_EQ(composition.coloring.title, "to the other's nearest point [m]");
  // Both are the same places: rounding of float32 at 50 m is 4 um, a step of the colours 1 mm.
  for (const PlacedCloud& cloud : composition.clouds) {
    EXPECT_THAT(cloud.colors, Each(MapColor(ColorMap::kViridis, 0.0)));
  }
}

TEST(ComposeDistances, ColoursByHowFarTheOtherIsAway) {
  const auto a = SharedCloud(kSparseWorld_m);
  std::vector<Vector3> shifted_m = kSparseWorld_m;
  for (std::size_t i = 0; i < shifted_m.size(); ++i)
    shifted_m[i].z() += 0.5 * static_cast<double>(i);
  Choices choices{.distance_ends_m = {{0.0, 2.0}}};
  const Composition composition = ComposeDistances(a, SharedCloud(shifted_m), choices);
  EXPECT_TRUE(composition.clouds[1].view_from_sensor.isApprox(Transform::Identity(), 0.0));
  EXPECT_EQ(composition.coloring.ends, choices.distance_ends_m);
  for (const PlacedCloud& cloud : composition.clouds) {
    ASSERT_THAT(cloud.colors, SizeIs(4));
    for (std::size_t i = 0; i < 4; ++i) {
      const Rgb exact = MapColor(ColorMap::kViridis, 0.25 * static_cast<double>(i));
      for (std::size_t channel = 0; channel < 3; ++channel) {
        // The colour scale has 1024 steps.
        EXPECT_NEAR(cloud.colors[i][channel], exact[channel], 1.0);
      }
    }
  }
}

TEST(ComposeDistances, FitsItsScaleFromZeroToTheFirstsDistances) {
  const auto a = SharedCloud({{100, 0, 0}, {110, 0, 0}});
  const auto b = SharedCloud({{100, 0, 0.375}, {110, 0, 1.5}});
  const Composition composition = ComposeDistances(a, b, {});
  EXPECT_EQ(composition.coloring.ends, (std::array{0.0, 1.5}));
  EXPECT_THAT(
      composition.clouds[0].colors,
      ElementsAre(MapColor(ColorMap::kViridis, 256.0 / 1023.0), MapColor(ColorMap::kViridis, 1.0)));
}

TEST(ComposeDistances, HasAScaleForCloudsThatAreTheSame) {
  const auto a = SharedCloud({{100, 0, 0}, {110, 0, 0}});
  EXPECT_EQ(ComposeDistances(a, a, {}).coloring.ends, (std::array{0.0, 0.5}));
}

TEST(ComposeDistances, HasNoColoursWhereThereIsNothingNear) {
  const Composition composition =
      ComposeDistances(SharedCloud(kSparseWorld_m), SharedCloud({}), {});
  EXPECT_THAT(composition.clouds[0].colors, Each(kNoValueColor));
  EXPECT_THAT(composition.clouds[1].colors, IsEmpty());
}

using testing::ElementsAre;
using testing::FloatNear;
using testing::IsEmpty;

ShownFrame PosedFrame(const std::vector<Vector3>& points_m, const Transform& world_from_sensor) {
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
      PosedFrame({{30, 0, 0}, {30, 5, 0}}, MakeTransform(Eigen::Matrix3d::Identity(), origin_m));
  const ShownFrame north =
      PosedFrame({{5, -10, 0.25}, {0, -10, 0}},
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
      PosedFrame({{30, 0, 2}}, MakeTransform(Eigen::Matrix3d::Identity(), Vector3(100, 0, 0)));
  EXPECT_FALSE(FirstFromSecond(bare, posed));
  EXPECT_FALSE(FirstFromSecond(posed, bare));
  EXPECT_THAT(DistancesToNearest_m(bare, posed), ElementsAre(2.0F));
}

TEST(CloudDistances, LayTheSecondFrameOverTheFirst) {
  const Transform first = MakeTransform(Eigen::Matrix3d::Identity(), Vector3(100, 0, 0));
  const Transform second =
      MakeTransform(RotationFromYawPitchRoll(std::numbers::pi / 2.0, 0.0, 0.0), Vector3(120, 1, 0));
  const auto first_from_second = FirstFromSecond(PosedFrame({}, first), PosedFrame({}, second));
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
