#include "analysis/compare/separability.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "analysis/compare/compare_report.h"
#include "tests/analysis/compare/made_clouds.h"

namespace railcast {
namespace {

using testing::ElementsAre;

std::size_t FeatureNamed(std::string_view key) {
  const auto at = std::ranges::find(kPatchFeatures, key, &PatchFeature::key);
  return static_cast<std::size_t>(at - kPatchFeatures.begin());
}

double FeatureOf(const Patch& patch, std::string_view key) {
  return static_cast<double>(patch.features.at(FeatureNamed(key)));
}

// 20 x 20 points spread evenly over the cube from (x, y, z), in the middle of a layer of its cells.
std::vector<MadePoint> Sheet(float x, float y, float z) {
  std::vector<MadePoint> points;
  for (int i = 0; i < 20; ++i) {
    for (int j = 0; j < 20; ++j) {
      points.push_back({x + 0.05F + 0.1F * static_cast<float>(i),
                        y + 0.05F + 0.1F * static_cast<float>(j), z + 0.75F});
    }
  }
  return points;
}

TEST(Patches, OfALevelSheetAreFlatAndHaveNoThickness) {
  const std::vector<Patch> patches = PatchesOf(FrameOf(Sheet(10.0F, -2.0F, -2.0F)));
  ASSERT_EQ(patches.size(), 1U);
  const Patch& patch = patches.front();
  EXPECT_NEAR(FeatureOf(patch, "linearity"), 0.0, 1e-4);
  EXPECT_NEAR(FeatureOf(patch, "planarity"), 1.0, 1e-4);
  EXPECT_NEAR(FeatureOf(patch, "scattering"), 0.0, 1e-4);
  EXPECT_NEAR(FeatureOf(patch, "thickness_m"), 0.0, 1e-4);
  EXPECT_NEAR(FeatureOf(patch, "roughness_m"), 0.0, 1e-4);
  EXPECT_NEAR(FeatureOf(patch, "inclination_deg"), 0.0, 0.01);
  EXPECT_NEAR(FeatureOf(patch, "height_spread_m"), 0.0, 1e-4);
  // The middle is at (11, -1, -1.25).
  EXPECT_NEAR(patch.range_m, std::sqrt(123.5625), 1e-4);
  EXPECT_NEAR(FeatureOf(patch, "density_per_sr"), 400.0 * 123.5625 / 4.0, 0.1);
  EXPECT_NEAR(FeatureOf(patch, "filled_percent"), 25.0, 1e-6);
}

TEST(Patches, OfAnUprightWireAreLinear) {
  std::vector<MadePoint> points;
  for (int i = 0; i < 40; ++i)
    points.push_back({5.0F, 1.0F, 0.025F + 0.05F * static_cast<float>(i)});
  const std::vector<Patch> patches = PatchesOf(FrameOf(points));
  ASSERT_EQ(patches.size(), 1U);
  EXPECT_NEAR(FeatureOf(patches.front(), "linearity"), 1.0, 1e-6);
  // n equal steps of d have the variance d^2 (n^2 - 1) / 12.
  EXPECT_NEAR(FeatureOf(patches.front(), "height_spread_m"), 0.05 * std::sqrt(1599.0 / 12.0), 1e-6);
}

TEST(Patches, MeasureTheNoiseAboutSmallPlanes) {
  const auto frame = FrameOf(WithNoise(Sheet(0.0F, 0.0F, 0.0F), 0.02));
  // Of 25 points about a plane with three parameters, the deviations have 22 degrees of freedom.
  for (const Patch& patch : PatchesOf(frame)) {
    EXPECT_NEAR(FeatureOf(patch, "roughness_m"), 0.02 * std::sqrt(22.0 / 25.0), 0.002);
  }
}

TEST(Patches, AreTheSameElsewhere) {
  const auto noisy = [](float x, float y, float z) {
    RecordedFrame frame = FrameOf(WithNoise(Sheet(x, y, z), 0.02));
    frame.fields.insert("return_count");
    return PatchesOf(frame).at(0);
  };
  const Patch here = noisy(4.0F, 2.0F, 0.0F), there = noisy(-2.0F, -4.0F, 2.0F);
  for (std::size_t i = 0; i < kNumPatchFeatures; ++i) {
    if (kPatchFeatures.at(i).key == "density_per_sr") continue;
    EXPECT_NEAR(here.features.at(i), there.features.at(i), 1e-3F) << kPatchFeatures.at(i).key;
  }
}

TEST(Patches, WantTwentyPoints) {
  std::vector<MadePoint> points(19, MadePoint{1.0F, 1.0F, 1.0F});
  EXPECT_TRUE(PatchesOf(FrameOf(points)).empty());
  points.push_back({1.0F, 1.0F, 1.0F});
  points.push_back({NAN, 1.0F, 1.0F});
  EXPECT_EQ(PatchesOf(FrameOf(points)).size(), 1U);
}

TEST(Patches, LackWhatTheFrameLacks) {
  RecordedFrame frame = FrameOf(Sheet(0.0F, 0.0F, 0.0F));
  frame.fields.erase("intensity");
  const Patch patch = PatchesOf(frame).front();
  for (const char* const key : {"intensity", "intensity_spread", "several_returns_percent"}) {
    EXPECT_TRUE(std::isnan(FeatureOf(patch, key))) << key;
  }
}

TEST(Patches, CountPointsThatHaveOthersBesideThem) {
  RecordedFrame frame = FrameOf(Sheet(0.0F, 0.0F, 0.0F));
  frame.fields.insert("return_count");
  for (std::size_t i = 0; i < 100; ++i) frame.frame.return_count[i] = 2;
  EXPECT_EQ(FeatureOf(PatchesOf(frame).front(), "several_returns_percent"), 25.0);
}

/// A frame of 4 x 4 sheets with noise.
RecordedFrame NoisyFrame(double sigma_m, float intensity, unsigned seed) {
  std::mt19937 words(seed);
  std::normal_distribution<float> noise(0.0F, 1.0F);
  std::vector<MadePoint> points;
  for (int i = 0; i < 16; ++i) {
    for (MadePoint point :
         Sheet(static_cast<float>(2 * (i % 4)) + 4.0F, static_cast<float>(2 * (i / 4)), 0.0F)) {
      point.z += static_cast<float>(sigma_m) * noise(words);
      point.intensity = intensity + 0.1F * noise(words);
      points.push_back(point);
    }
  }
  return FrameOf(points);
}

PatchPairs MadePairs(int num, double sigma_b_m, float intensity_b = 0.5F) {
  PatchPairs pairs;
  for (int i = 0; i < num; ++i) {
    const auto seed = static_cast<unsigned>(i);
    pairs.Add({PatchesOf(NoisyFrame(0.02, 0.5F, seed)),
               PatchesOf(NoisyFrame(sigma_b_m, intensity_b, 1000 + seed))});
  }
  return pairs;
}

TEST(ToldApart, HoldsAHalfForTwoDrawsOfOneScene) {
  const Separability told = SeparabilityOf(MadePairs(20, 0.02));
  EXPECT_LT(told.area.low, 0.5);
  EXPECT_GT(told.area.high, 0.5);
  EXPECT_NEAR(told.balanced_accuracy.value, 0.5, 0.1);
  EXPECT_NEAR(told.shape_area.value, 0.5, 0.1);
}

TEST(ToldApart, TellsTwiceTheNoiseByItsRoughness) {
  const Separability told = SeparabilityOf(MadePairs(10, 0.04));
  EXPECT_GT(told.area.value, 0.99);
  EXPECT_GT(told.balanced_accuracy.value, 0.95);
  EXPECT_GT(told.shape_area.value, 0.99);
  for (const Separability::Feature& feature : told.features) {
    if (feature.index != FeatureNamed("roughness_m")) continue;
    EXPECT_EQ(feature.own_area, 1.0);
    EXPECT_NEAR(feature.median_b.value / feature.median_a.value, 2.0, 0.05);
  }
}

TEST(ToldApart, TellsIntensitiesButNotByTheShape) {
  const Separability told = SeparabilityOf(MadePairs(20, 0.02, 0.6F));
  EXPECT_GT(told.area.value, 0.99);
  EXPECT_LT(told.shape_area.low, 0.5);
  EXPECT_GT(told.shape_area.high, 0.5);
  ASSERT_FALSE(told.features.empty());
  EXPECT_EQ(told.features.front().index, FeatureNamed("intensity"));
}

TEST(ToldApart, LeavesOutFeaturesThatOneCloudLacks) {
  PatchPairs pairs;
  for (unsigned i = 0; i < 10; ++i) {
    RecordedFrame bare = NoisyFrame(0.02, 0.5F, 100 + i);
    bare.fields.erase("intensity");
    pairs.Add({PatchesOf(NoisyFrame(0.02, 0.5F, i)), PatchesOf(bare)});
  }
  const Separability told = SeparabilityOf(pairs);
  EXPECT_TRUE(told.is_enough());
  EXPECT_FALSE(told.shape_area.is_enough());
  EXPECT_EQ(told.features.size(), 9U);
  for (const auto& feature : told.features) EXPECT_FALSE(IsOfIntensity(feature.index));
}

TEST(ToldApart, SaysWhatIsMissing) {
  const PatchPairs pairs = MadePairs(9, 0.02);
  const Section section = MakeSeparabilitySection(pairs, SeparabilityOf(pairs));
  EXPECT_THAT(
      section.paragraphs,
      ElementsAre("Not enough to tell: it takes 10 pairs of frames with 100 patches of each "
                  "recording, some in every tenth of the pairs (got 144 patches of A and "
                  "144 of B in 9 pairs of frames). A patch is a cube of 2 m with 20 points "
                  "at least."));
  EXPECT_TRUE(section.tables.empty());
}

TEST(PatchPairs, AreBoundedInLongRecordings) {
  PatchPairs pairs;
  const std::vector<Patch> patches(400);
  for (int i = 0; i < 1000; ++i) pairs.Add({patches, patches});
  EXPECT_LE(pairs.num_a() + pairs.num_b(), 24'000U);
  EXPECT_GE(pairs.pairs().size(), 15U);
  EXPECT_EQ(pairs.stride(), 64U);
}

}  // namespace
}  // namespace railcast
