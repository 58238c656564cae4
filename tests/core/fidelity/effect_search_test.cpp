#include "core/fidelity/effect_search.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace railcast {
namespace {

constexpr EffectSet kFull{.extinction = true, .footprint = true, .thin_conductors = true};
const std::vector<EffectCost> kCandidates = {{&EffectSet::extinction, 2.0},
                                             {&EffectSet::footprint, 100.0},
                                             {&EffectSet::thin_conductors, 10.0}};
constexpr ToleranceSpec kTenPercent{.missed_share = 0.1};

// Makes a measure in which each effect that is off adds a fixed missed share.
std::function<Deviation(const EffectSet&)> MissedWithout(double extinction,
                                                         double footprint,
                                                         double thin_conductors,
                                                         double with_all = 0.0) {
  return [=](const EffectSet& effects) {
    return Deviation{.missed_share = with_all + (effects.extinction ? 0.0 : extinction) +
                                     (effects.footprint ? 0.0 : footprint) +
                                     (effects.thin_conductors ? 0.0 : thin_conductors)};
  };
}

TEST(EffectSearch, LeavesOutAllThatTheToleranceAllows) {
  const auto result =
      FindCheapestEffects(kFull, kCandidates, kTenPercent, MissedWithout(0.025, 0.025, 0.025));
  EXPECT_EQ(result.effects, EffectSet{});
  EXPECT_NEAR(result.deviation.missed_share, 0.075, 1e-12);
}

TEST(EffectSearch, LeavesOutTheDearestWhereNotAllCanGo) {
  const auto result =
      FindCheapestEffects(kFull, kCandidates, kTenPercent, MissedWithout(0.01, 0.065, 0.05));
  EXPECT_EQ(result.effects, (EffectSet{.thin_conductors = true}));
}

TEST(EffectSearch, KeepsWhatCostsNextToNothingUnlessItChangesNothing) {
  const std::vector<EffectCost> candidates = {{&EffectSet::extinction, 0.9},
                                              {&EffectSet::footprint, 100.0},
                                              {&EffectSet::thin_conductors, 0.9}};
  const auto result =
      FindCheapestEffects(kFull, candidates, kTenPercent, MissedWithout(0.001, 0.01, 0.0));
  EXPECT_EQ(result.effects, EffectSet{.extinction = true});
}

TEST(EffectSearch, SaysWhatEachEffectWouldChange) {
  const auto result =
      FindCheapestEffects(kFull, kCandidates, kTenPercent, MissedWithout(0.01, 0.8, 0.05));
  ASSERT_EQ(result.without.size(), 3U);
  EXPECT_EQ(result.without[0].missed_share, 0.01);
  EXPECT_EQ(result.without[1].missed_share, 0.8);
  EXPECT_EQ(result.without[2].missed_share, 0.05);
}

TEST(EffectSearch, PutsBackWhatIsMissedMostWhereEffectsWorkOnEachOther) {
  // Without thin_conductors alone nothing is missed, without footprint alone 2 % of the echoes are,
  // without both of them half.
  const auto measure = [](const EffectSet& effects) {
    const bool is_poor = !effects.footprint && !effects.thin_conductors;
    return Deviation{.missed_share = is_poor ? 0.5 : effects.footprint ? 0.0 : 0.02};
  };
  const auto result = FindCheapestEffects(kFull, kCandidates, {.missed_share = 0.1}, measure);
  EXPECT_NE(result.effects.footprint, result.effects.thin_conductors);
  EXPECT_FALSE(result.effects.extinction);
  EXPECT_LE(result.deviation.missed_share, 0.1);
}

TEST(EffectSearch, PutsAllBackIfNothingElseHelps) {
  const auto measure = [](const EffectSet& effects) {
    const int num_off = (effects.extinction ? 0 : 1) + (effects.footprint ? 0 : 1) +
                        (effects.thin_conductors ? 0 : 1);
    return Deviation{.missed_share = num_off > 1 ? 0.9 : 0.03 * num_off};
  };
  const auto result = FindCheapestEffects(kFull, kCandidates, kTenPercent, measure);
  EXPECT_LE(result.deviation.missed_share, 0.1);
  EXPECT_TRUE(result.effects.extinction || result.effects.footprint);
}

TEST(EffectSearch, KeepsAMarginForOtherFrames) {
  const auto result =
      FindCheapestEffects(kFull, kCandidates, kTenPercent, MissedWithout(0.0, 0.09, 0.0));
  EXPECT_EQ(result.effects, EffectSet{.footprint = true});
}

TEST(EffectSearch, AllowsLittleMoreThanAllEffectsReach) {
  // 0.0015 is within 0.02 of the tolerance, twice as much is not. Wires are more expensive.
  const auto result =
      FindCheapestEffects(kFull, kCandidates, kTenPercent, MissedWithout(0.0015, 0.5, 0.0015, 0.3));
  EXPECT_EQ(result.effects, (EffectSet{.extinction = true, .footprint = true}));
}

TEST(EffectSearch, KeepsWhatChangesAnythingAtNoTolerance) {
  const ToleranceSpec none{.range_m = 0.0,
                           .missed_share = 0.0,
                           .false_share = 0.0,
                           .thin_missed_share = 0.0,
                           .intensity = 0.0};
  const auto result =
      FindCheapestEffects(kFull, kCandidates, none, MissedWithout(0.0, 1e-6, 1e-6, 0.3));
  EXPECT_EQ(result.effects, (EffectSet{.footprint = true, .thin_conductors = true}));
}

TEST(EffectSearch, IsNotDeceivedByAChangeForTheBetter) {
  // By chance fewer echoes are missed without extinction. That must not allow leaving out another
  // effect.
  const auto result =
      FindCheapestEffects(kFull, kCandidates, kTenPercent, MissedWithout(-0.05, 0.12, 0.0, 0.0));
  EXPECT_TRUE(result.effects.footprint);
}

TEST(Deviation, IsInfiniteWithoutAnyIntensity) {
  FrameDifference difference;
  difference.echoes = {4, 2};
  difference.reference_echoes = {5, 2};
  const Deviation deviation = DeviationOf(difference);
  EXPECT_TRUE(std::isinf(deviation.intensity));
  EXPECT_EQ(deviation.false_share, 0.5);
  EXPECT_EQ(deviation.missed_share, 1.0 - 2.0 / 5.0);
  EXPECT_FALSE(IsWithin(deviation, {.missed_share = 1.0, .false_share = 1.0, .intensity = 1e9}));
}

TEST(Deviation, IsWithinUpToTheLimit) {
  const Deviation deviation{.range_m = 0.02};
  EXPECT_TRUE(IsWithin(deviation, {.range_m = 0.02}));
  EXPECT_FALSE(IsWithin(deviation, {.range_m = 0.019}));
}

}  // namespace
}  // namespace railcast
