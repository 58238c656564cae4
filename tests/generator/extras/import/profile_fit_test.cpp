#include "generator/extras/import/heights/profile_fit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace railcast {
namespace {

using ::testing::SizeIs;

/// A line for 100 km/h: level, up, level, down, with the vertical curves that the speed needs.
AlignmentSpec Hill() {
  AlignmentSpec spec;
  spec.course = AlignmentElementsSpec{{{ElementType::kStraight, 6000.0, {}}}};
  spec.origin_m = {0.0, 0.0, 250.0};
  spec.gradients_permil = {{0.0, 0.0}, {1200.0, 12.0}, {2750.0, 2.0}, {4100.0, -15.0}};
  // The largest step times 0.35 * 100^2.
  spec.gradient_smoothing_m = 17e-3 * 3500.0;
  return spec;
}

std::vector<HeightSample> SamplesOf(const AlignmentSpec& spec, double step_m, double sigma_m) {
  std::mt19937 dice(5);
  std::normal_distribution<double> off(0.0, 1.0);
  const Alignment alignment(spec);
  std::vector<HeightSample> samples;
  for (double s_m = 0.0; s_m <= alignment.length_m(); s_m += step_m) {
    samples.push_back({s_m, alignment.At(s_m).position_m.z() + sigma_m * off(dice)});
  }
  return samples;
}

ProfilePrior For(double length_m, double sigma_m) {
  return {.length_m = length_m, .sigma_m = sigma_m, .speed_kmph = [](double) { return 100.0; }};
}

/// The largest difference in height between a profile and a line.
double LargestDifference_m(const Profile& profile, const AlignmentSpec& spec) {
  AlignmentSpec fitted = spec;
  fitted.origin_m[2] = profile.start_z_m;
  fitted.gradients_permil = profile.gradients_permil;
  fitted.gradient_smoothing_m = profile.smoothing_m;
  const Alignment line(fitted);
  const Alignment truth(spec);
  double largest_m = 0.0;
  for (double s_m = 0.0; s_m <= truth.length_m(); s_m += 10.0) {
    largest_m =
        std::max(largest_m, std::abs(line.At(s_m).position_m.z() - truth.At(s_m).position_m.z()));
  }
  return largest_m;
}

TEST(ProfileFit, FindsTheGradientsFromWhichHeightsWereMade) {
  const AlignmentSpec spec = Hill();
  constexpr double kSigma_m = 0.02;
  const Profile profile = FitProfile(SamplesOf(spec, 20.0, kSigma_m), For(6000.0, kSigma_m));
  ASSERT_THAT(profile.gradients_permil, SizeIs(4));
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(profile.gradients_permil[i].s_m, spec.gradients_permil[i].s_m, 10.0) << i;
    EXPECT_NEAR(profile.gradients_permil[i].value, spec.gradients_permil[i].value, 0.05) << i;
  }
  EXPECT_NEAR(profile.smoothing_m, spec.gradient_smoothing_m, 1.5);
  EXPECT_NEAR(profile.start_z_m, 250.0, 2.0 * kSigma_m);
  // Some 70 samples hold each gradient, so that its ends are known to about sigma / 4.
  EXPECT_LT(LargestDifference_m(profile, spec), kSigma_m);
}

TEST(ProfileFit, NeedsNoMoreGradientsThanTheLineHasFromNoisyHeights) {
  const AlignmentSpec spec = Hill();
  constexpr double kSigma_m = 1.0;
  const Profile profile = FitProfile(SamplesOf(spec, 30.0, kSigma_m), For(6000.0, kSigma_m));
  EXPECT_THAT(profile.gradients_permil, SizeIs(4));
  EXPECT_LT(LargestDifference_m(profile, spec), kSigma_m);
}

TEST(ProfileFit, IsNotBentByHeightsThatAreFarOff) {
  const AlignmentSpec spec = Hill();
  std::vector<HeightSample> samples = SamplesOf(spec, 30.0, 0.3);
  for (std::size_t i = 20; i < samples.size(); i += 25) samples[i].z_m += 8.0;
  EXPECT_LT(LargestDifference_m(FitProfile(samples, For(6000.0, 0.3)), spec), 0.6);
}

TEST(ProfileFit, GoesStraightOnWhereThereAreNoHeights) {
  const AlignmentSpec spec = Hill();
  std::vector<HeightSample> samples = SamplesOf(spec, 30.0, 0.3);
  std::erase_if(samples, [](const HeightSample& at) { return at.s_m > 1500.0 && at.s_m < 2500.0; });
  const Profile profile = FitProfile(samples, For(6000.0, 0.3));
  EXPECT_THAT(profile.gradients_permil, SizeIs(4));
  EXPECT_LT(LargestDifference_m(profile, spec), 0.6);
}

/// A slope of 80 permil over 500 m, as terrain has it.
TEST(ProfileFit, KeepsToTheLimitsOfRailways) {
  std::vector<HeightSample> samples;
  for (double s_m = 0.0; s_m <= 5000.0; s_m += 25.0) {
    samples.push_back({s_m, 80e-3 * std::clamp(s_m - 2000.0, 0.0, 500.0)});
  }
  const Profile profile = FitProfile(samples, For(5000.0, 0.5));
  for (const ChainageValue& gradient : profile.gradients_permil) {
    EXPECT_LE(std::abs(gradient.value), 1e3 * kSteepest);
  }
  EXPECT_GE(profile.least_roundness, 1.0);
}

TEST(ProfileFit, HasRoundEnoughCurvesOnRoughTerrain) {
  std::mt19937 dice(1);
  std::normal_distribution<double> step_m(0.0, 2.0);
  std::vector<HeightSample> samples;
  double z_m = 300.0;
  for (double s_m = 0.0; s_m <= 20000.0; s_m += 50.0) samples.push_back({s_m, z_m += step_m(dice)});
  const Profile profile = FitProfile(samples, For(20000.0, 1.0));
  EXPECT_GT(profile.gradients_permil.size(), 5U);
  EXPECT_GE(profile.least_roundness, 1.0);
}

TEST(ProfileFit, IsLevelWithoutHeights) {
  const Profile none = FitProfile({}, For(100.0, 1.0));
  EXPECT_EQ(none.start_z_m, 0.0);
  EXPECT_EQ(none.gradients_permil, (std::vector<ChainageValue>{{0.0, 0.0}}));
  const std::vector<HeightSample> one = {{50.0, 7.0}};
  EXPECT_EQ(FitProfile(one, For(100.0, 1.0)).start_z_m, 7.0);
}

TEST(ProfileFit, TakesHeightsAtOnePlaceOnly) {
  const std::vector<HeightSample> samples = {{0.0, 5.0}, {0.0, 7.0}, {0.0, 6.0}};
  const Profile profile = FitProfile(samples, For(100.0, 1.0));
  EXPECT_NEAR(profile.start_z_m, 6.0, 1e-3);
}

}  // namespace
}  // namespace railcast
