#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/viewer/composition/shared_clouds.h"
#include "viewer/composition/compose_distances.h"

namespace railcast {
namespace {

using testing::Each;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

/// The points are so far apart that, after the shifts in these tests, each is still nearest to
/// itself.
const std::vector<Vector3> sparse_world_m = {{100, 0, 0}, {110, 0, 0}, {100, 10, 0}, {100, 0, 20}};

TEST(ComposeDistances, LaysTheSecondWhereItWasInTheFirstsAxes) {
  const Transform first = MakeTransform(RotationFromYawPitchRoll(0.3, 0.0, 0.0), {60, 0, 0});
  const Transform second = MakeTransform(RotationFromYawPitchRoll(-1.2, 0.1, 0.0), {90, 5, 1});
  const auto a = Posed(sparse_world_m, first);
  const auto b = Posed(sparse_world_m, second);
  Choices choices;
  choices.distance_ends_m = {{0.0, 1.0}};
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
  const auto a = SharedCloud(sparse_world_m);
  std::vector<Vector3> shifted_m = sparse_world_m;
  for (std::size_t i = 0; i < shifted_m.size(); ++i)
    shifted_m[i].z() += 0.5 * static_cast<double>(i);
  Choices choices;
  choices.distance_ends_m = {{0.0, 2.0}};
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
      ComposeDistances(SharedCloud(sparse_world_m), SharedCloud({}), {});
  EXPECT_THAT(composition.clouds[0].colors, Each(kNoValueColor));
  EXPECT_THAT(composition.clouds[1].colors, IsEmpty());
}

}  // namespace
}  // namespace railcast
