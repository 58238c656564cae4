#include "core/detect/beam/echo_finder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "core/base/random.h"
#include "core/detect/base/beam_optics.h"

namespace railcast {
namespace {

const BeamSpec kBeam;
const auto kSigma_m = static_cast<float>(PulseSigma_m(kBeam));

std::vector<Echo> Find(std::vector<Component> components,
                       bool is_sampled,
                       bool has_stretch = true,
                       EchoSignal signal = EchoSignal::kPeak) {
  constexpr float kLeastRatio = 0.3F;
  const DetectorSpec spec{.effects = {.pulse_stretch = has_stretch, .sampled_waveform = is_sampled},
                          .beam = kBeam,
                          .receiver = {.signal = signal}};
  EchoFinder finder(spec, kLeastRatio, AvailableKernels().back());
  std::vector<Echo> echoes;
  finder.Add(components);
  finder.FindPeaks();
  finder.EchoesOf(0, echoes);
  return echoes;
}

Component At(float range_m, float power_ratio = 10.0F, std::uint32_t surface = 1) {
  return {.range_m = range_m,
          .power_ratio = power_ratio,
          .share = 0.25F,
          .intensity = 0.1F,
          .cos_incidence = 1.0F,
          .reflectivity = 0.5F,
          .surface = surface};
}

float ShareOf(const std::vector<Echo>& echoes) {
  return std::accumulate(echoes.begin(), echoes.end(), 0.0F,
                         [](float sum, const Echo& echo) { return sum + echo.share; });
}

TEST(EchoFinder, GivesASingleComponentBackExactly) {
  Component component = At(42.5F, 7.0F, 3);
  component.spread_m = 0.4F;
  const auto echoes = Find({component}, false);
  ASSERT_EQ(echoes.size(), 1U);
  EXPECT_EQ(echoes[0].peak_range_m, 42.5F);
  EXPECT_EQ(echoes[0].true_range_m, 42.5F);
  EXPECT_EQ(echoes[0].power_ratio, 7.0F);
  EXPECT_EQ(echoes[0].share, 0.25F);
  EXPECT_EQ(echoes[0].surface, 3U);
}

TEST(EchoFinder, SampledFindsASingleComponentToATenthOfAMillimetre) {
  for (float range_m = 42.0F; range_m < 42.1F; range_m += 0.007F) {
    const auto echoes = Find({At(range_m)}, true);
    ASSERT_EQ(echoes.size(), 1U);
    EXPECT_NEAR(static_cast<double>(echoes[0].peak_range_m), static_cast<double>(range_m), 1e-4);
    EXPECT_NEAR(static_cast<double>(echoes[0].power_ratio), 10.0, 1e-3);
  }
}

TEST(EchoFinder, FindsNothingInNothing) {
  EXPECT_TRUE(Find({}, false).empty());
  EXPECT_TRUE(Find({}, true).empty());
}

// A surface behind a gap in a hedge, for example.
TEST(EchoFinder, PutsNothingOfAPeakThatIsTooWeakIntoAnother) {
  for (const bool is_sampled : {false, true}) {
    for (const EchoSignal signal : {EchoSignal::kPeak, EchoSignal::kEnergy}) {
      const auto echoes = Find({At(30.0F), At(200.0F, 0.2F, 1)}, is_sampled, true, signal);
      ASSERT_EQ(echoes.size(), 1U);
      EXPECT_EQ(echoes[0].true_range_m, 30.0F);
      EXPECT_EQ(echoes[0].intensity, 0.1F);
      EXPECT_EQ(echoes[0].share, 0.25F);
    }
  }
}

// In dense fog a wave is 0 where floats end.
TEST(EchoFinder, FindsNoPeakBesideWhatIsTooWeakToBeCounted) {
  for (const EchoSignal signal : {EchoSignal::kPeak, EchoSignal::kEnergy}) {
    for (const float power : {1e-38F, 1e-42F, 1e-45F}) {
      for (const Echo& echo : Find({At(30.0F, power), At(30.5F, power)}, true, true, signal)) {
        EXPECT_TRUE(std::isfinite(echo.peak_range_m)) << power;
      }
    }
  }
}

// The sum of two equal Gaussians has two maxima exactly where they are more than 2 sigma apart.
TEST(EchoFinder, ResolvesTwoEqualPulsesAboveTwoSigmaAndMeltsThemBelow) {
  for (const bool is_sampled : {false, true}) {
    EXPECT_EQ(Find({At(30.0F), At(30.0F + 2.2F * kSigma_m, 10.0F, 2)}, is_sampled).size(), 2U);
    EXPECT_EQ(Find({At(30.0F), At(30.0F + 1.8F * kSigma_m, 10.0F, 2)}, is_sampled).size(), 1U);
  }
}

TEST(EchoFinder, ResolvesFarPulsesEachAtItsOwnRangeAndPower) {
  for (const bool is_sampled : {false, true}) {
    const auto echoes = Find({At(30.0F), At(40.0F, 2.0F, 2), At(35.0F, 5.0F, 3)}, is_sampled);
    ASSERT_EQ(echoes.size(), 3U);
    EXPECT_NEAR(static_cast<double>(echoes[0].peak_range_m), 30.0, 1e-4);
    EXPECT_NEAR(static_cast<double>(echoes[1].peak_range_m), 35.0, 1e-4);
    EXPECT_NEAR(static_cast<double>(echoes[2].power_ratio), 2.0, 2e-4);
    EXPECT_EQ(echoes[1].surface, 3U);
  }
}

// If two pulses are less than a sigma apart, the peak is their power-weighted mean, up to third
// order in the distance.
TEST(EchoFinder, PutsAMixedPixelBetweenItsSurfaces) {
  for (const bool is_sampled : {false, true}) {
    const float step_m = 0.3F * kSigma_m;
    const auto echoes = Find({At(30.0F, 3.0F, 1), At(30.0F + step_m, 9.0F, 2)}, is_sampled);
    ASSERT_EQ(echoes.size(), 1U);
    EXPECT_NEAR(static_cast<double>(echoes[0].peak_range_m),
                static_cast<double>(30.0F + 0.75F * step_m), 2e-3);
    EXPECT_EQ(echoes[0].true_range_m, 30.0F + step_m);
    EXPECT_EQ(echoes[0].surface, 2U);
    EXPECT_EQ(echoes[0].share, 0.5F);
  }
}

TEST(EchoFinder, KeepsTheStrongestEchoHoweverWeakAndDropsOthersBelowAThird) {
  EXPECT_EQ(Find({At(30.0F, 0.01F)}, false).size(), 1U);
  EXPECT_EQ(Find({At(30.0F, 0.2F), At(40.0F, 5.0F)}, false).size(), 1U);
  EXPECT_EQ(Find({At(30.0F, 0.4F), At(40.0F, 5.0F)}, false).size(), 2U);
}

TEST(EchoFinder, GivesTheStretchedComponentLessSay) {
  Component stretched = At(30.0F);
  stretched.spread_m = 1.0F;
  const std::vector<Component> both{stretched, At(30.0F + 0.5F * kSigma_m, 10.0F, 2)};
  const auto with = Find(both, false, true);
  const auto without = Find(both, false, false);
  EXPECT_GT(with[0].peak_range_m, without[0].peak_range_m + 0.05F * kSigma_m);
}

// A surface that stretches the pulse to five times its length, cut into pieces along the beam: the
// peak falls, the energy stays.
TEST(EchoFinder, AddsUpTheEnergyOfAStretchedSurface) {
  constexpr float kStretch = 5.0F;
  const float stretched_m = kSigma_m * std::sqrt(kStretch * kStretch - 1.0F);
  const float step_m = 0.5F * kSigma_m;
  std::vector<Component> pieces;
  float total = 0.0F;
  for (int i = -40; i <= 40; ++i) {
    const float from_middle_m = step_m * static_cast<float>(i);
    const float z = from_middle_m / stretched_m;
    pieces.push_back(At(60.0F + from_middle_m, std::exp(-0.5F * z * z)));
    total += pieces.back().power_ratio;
  }
  for (const bool is_sampled : {false, true}) {
    const auto peak = Find(pieces, is_sampled, true, EchoSignal::kPeak);
    const auto energy = Find(pieces, is_sampled, true, EchoSignal::kEnergy);
    ASSERT_EQ(energy.size(), 1U);
    ASSERT_EQ(peak.size(), 1U);
    EXPECT_NEAR(static_cast<double>(peak[0].peak_range_m), 60.0, 1e-3);
    EXPECT_NEAR(static_cast<double>(energy[0].power_ratio / total), 1.0, 1e-4);
    EXPECT_NEAR(static_cast<double>(peak[0].power_ratio / total), 1.0 / 5.0, 0.002);
  }
}

// An echo of energy is as strong as its components however far they are stretched, and no other
// echo lends it any.
TEST(EchoFinder, KeepsTheEnergiesOfSeparateEchoesApart) {
  for (const bool is_sampled : {false, true}) {
    std::vector<Component> components{At(30.0F), At(40.0F, 2.0F, 2), At(35.0F, 0.2F, 3)};
    components[1].spread_m = 2.0F;
    const auto echoes = Find(components, is_sampled, true, EchoSignal::kEnergy);
    ASSERT_EQ(echoes.size(), 2U);
    EXPECT_NEAR(static_cast<double>(echoes[0].power_ratio), 10.0, 1e-3);
    EXPECT_NEAR(static_cast<double>(echoes[1].power_ratio), 2.0, 1e-3);
  }
}

// Pieces of one surface that are a little farther apart than resolvable ripple the wave. A receiver
// of energy sees one echo, and two where a real gap lies between surfaces.
TEST(EchoFinder, TakesTheRipplesOfASurfaceForOneEchoOfEnergy) {
  std::vector<Component> pieces;
  for (int i = 0; i < 12; ++i) {
    const float jitter = i % 2 == 0 ? 0.04F : -0.04F;
    pieces.push_back(At(30.0F + kSigma_m * (1.85F * static_cast<float>(i) + jitter), 1.0F));
  }
  for (const bool is_sampled : {false, true}) {
    EXPECT_GT(Find(pieces, is_sampled, true, EchoSignal::kPeak).size(), 3U);
    const auto echoes = Find(pieces, is_sampled, true, EchoSignal::kEnergy);
    ASSERT_EQ(echoes.size(), 1U);
    EXPECT_NEAR(static_cast<double>(echoes[0].power_ratio), 12.0, 1e-3);
    for (const Component& behind : {At(30.0F + 2.7F * kSigma_m), At(31.7F, 0.4F)}) {
      const auto two = Find({At(30.0F, 40.0F), behind}, is_sampled, true, EchoSignal::kEnergy);
      const auto by_peak = Find({At(30.0F, 40.0F), behind}, is_sampled);
      EXPECT_EQ(two.size(), by_peak.size());
    }
  }
}

// A random list of 1 to 40 components within 6 m on a few surfaces, with varied powers and spreads.
std::vector<Component> RandomComponents(std::uint32_t item) {
  const auto words = RandomWords(3, RandomUse::kNoise, 1, item);
  std::vector<Component> components;
  const std::uint32_t count = 1 + words[0] % 40;
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto w = RandomWords(3, RandomUse::kNoise, 2 + i, item);
    Component component = At(50.0F + 1.5F * static_cast<float>(w[0] % 5), 0.0F, 1 + w[0] % 5);
    component.range_m += 0.1F * UnitFloat(w[1]);
    component.power_ratio = 0.2F + 5.0F * UnitFloat(w[2]);
    component.spread_m = 0.2F * UnitFloat(w[3]);
    component.share = 1.0F / static_cast<float>(count);
    components.push_back(component);
  }
  return components;
}

TEST(EchoFinder, ClimbsToThePeaksThatSamplesFind) {
  for (std::uint32_t item = 0; item < 3000; ++item) {
    const auto components = RandomComponents(item);
    const auto climbed = Find(components, false);
    const auto sampled = Find(components, true);
    ASSERT_EQ(climbed.size(), sampled.size()) << item;
    for (std::size_t i = 0; i < climbed.size(); ++i) {
      ASSERT_NEAR(static_cast<double>(climbed[i].peak_range_m),
                  static_cast<double>(sampled[i].peak_range_m), 1e-3)
          << item;
      ASSERT_NEAR(static_cast<double>(climbed[i].power_ratio / sampled[i].power_ratio), 1.0, 1e-3)
          << item;
      ASSERT_EQ(climbed[i].surface, sampled[i].surface) << item;
    }
  }
}

bool IsSame(const std::vector<Echo>& climbed, const std::vector<Echo>& sampled) {
  return std::equal(climbed.begin(), climbed.end(), sampled.begin(), sampled.end(),
                    [](const Echo& a, const Echo& b) {
                      return std::fabs(a.peak_range_m - b.peak_range_m) < 0.02F &&
                             std::fabs(a.power_ratio / b.power_ratio - 1.0F) < 1e-3F;
                    });
}

// A beam of 16 sub-rays on grazed ground: random ranges over many pulse lengths, each with a
// quarter of the spread of the whole.
TEST(EchoFinder, ClimbsToThePeaksOfWidelyStretchedSurfaces) {
  constexpr std::uint32_t kNumBeams = 1000;
  std::uint32_t num_same = 0;
  for (std::uint32_t item = 0; item < kNumBeams; ++item) {
    const auto words = RandomWords(3, RandomUse::kNoise, 1, item);
    const float whole_m = 8.0F * UnitFloat(words[0]);
    std::vector<Component> components;
    for (std::uint32_t i = 0; i < 16; ++i) {
      const auto w = RandomWords(3, RandomUse::kNoise, 2 + i, item);
      Component component = At(80.0F, 0.5F + UnitFloat(w[0]));
      component.range_m += whole_m * (UnitFloat(w[1]) + UnitFloat(w[2]) + UnitFloat(w[3]) - 1.5F);
      component.spread_m = 0.25F * whole_m;
      components.push_back(component);
    }
    num_same += IsSame(Find(components, false), Find(components, true)) ? 1 : 0;
  }
  // Where two maxima are hardly apart, or one is hardly higher than what surrounds it, samples and
  // rounding decide.
  EXPECT_GE(num_same, kNumBeams * 99 / 100);
}

// The waves of a grazed piece of ground and of things before and behind it: steps that suit the
// ground jump over the peaks of the things.
TEST(EchoFinder, ClimbsToThePeaksOfThingsOnStretchedGround) {
  constexpr std::uint32_t kNumBeams = 2000;
  std::uint32_t num_same = 0;
  for (std::uint32_t item = 0; item < kNumBeams; ++item) {
    const auto words = RandomWords(3, RandomUse::kNoise, 1, item);
    std::vector<Component> components{At(80.0F, 0.5F + 4.0F * UnitFloat(words[0]))};
    components[0].spread_m = 0.5F + 4.0F * UnitFloat(words[1]);
    for (std::uint32_t i = 0; i < 1 + words[2] % 2; ++i) {
      const auto w = RandomWords(3, RandomUse::kNoise, 2 + i, item);
      Component thing = At(77.0F + 6.0F * UnitFloat(w[0]), 0.2F + 5.0F * UnitFloat(w[1]), 2 + i);
      thing.spread_m = 0.1F * UnitFloat(w[2]);
      components.push_back(thing);
    }
    num_same += IsSame(Find(components, false), Find(components, true)) ? 1 : 0;
  }
  EXPECT_GE(num_same, kNumBeams * 99 / 100);
}

TEST(EchoFinder, LosesNoShareOfTheBeamThatIsStrongEnough) {
  for (std::uint32_t item = 0; item < 300; ++item) {
    std::vector<Component> components = RandomComponents(item);
    for (Component& component : components) component.power_ratio += 0.3F;
    for (const bool is_sampled : {false, true}) {
      ASSERT_NEAR(static_cast<double>(ShareOf(Find(components, is_sampled))), 1.0, 1e-5);
    }
  }
}

}  // namespace
}  // namespace railcast
