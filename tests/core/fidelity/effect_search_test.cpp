#include "core/fidelity/effect_search.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/detect/detector/effect_table.h"
#include "core/fidelity/echoes_by_range.h"
#include "railcast/effects.h"

namespace railcast {
namespace {

// Extinction, footprint and thin conductors, say.
const std::vector<double> kSavings = {2.0, 100.0, 10.0};
constexpr Omissions kFirst = 1U << 0U;
constexpr Omissions kDearest = 1U << 1U;
constexpr Omissions kLast = 1U << 2U;
const ToleranceSpec kTenPercent{.missed_share = 0.1};

using MeasureOne = std::function<Deviation(Omissions)>;

EffectSearchResult Search(const ToleranceSpec& tolerance, const MeasureOne& measure) {
  return FindOmissions(kSavings, tolerance, [&](const std::vector<Omissions>& sets) {
    std::vector<Deviation> deviations;
    for (const Omissions set : sets) deviations.push_back(measure(set));
    return deviations;
  });
}

// Makes a measure in which each candidate that is left out adds a fixed missed share.
MeasureOne MissedWithout(double first, double dearest, double last, double with_all = 0.0) {
  return [=](Omissions set) {
    return Deviation{.missed_share = with_all + (IsIn(set, 0) ? first : 0.0) +
                                     (IsIn(set, 1) ? dearest : 0.0) + (IsIn(set, 2) ? last : 0.0)};
  };
}

TEST(EffectSearch, LeavesOutAllThatTheToleranceAllows) {
  const auto result = Search(kTenPercent, MissedWithout(0.025, 0.025, 0.025));
  EXPECT_EQ(result.left_out, kFirst | kDearest | kLast);
  EXPECT_NEAR(result.deviation.missed_share, 0.075, 1e-12);
}

TEST(EffectSearch, LeavesOutTheDearestWhereNotAllCanGo) {
  const auto result = Search(kTenPercent, MissedWithout(0.05, 0.05, 0.05));
  EXPECT_EQ(result.left_out, kDearest);
}

TEST(EffectSearch, SaysWhatEachEffectWouldChange) {
  const auto result = Search(kTenPercent, MissedWithout(0.01, 0.8, 0.05));
  ASSERT_EQ(result.without.size(), 3U);
  EXPECT_EQ(result.without[0].missed_share, 0.01);
  EXPECT_EQ(result.without[1].missed_share, 0.8);
  EXPECT_EQ(result.without[2].missed_share, 0.05);
}

TEST(EffectSearch, PutsBackWhatIsMissedMostWhereEffectsWorkOnEachOther) {
  // Without wires alone nothing is missed, without footprint alone 2 % of the echoes are, without
  // both of them half.
  const auto result = Search(kTenPercent, [](Omissions set) {
    const bool is_poor = IsIn(set, 1) && IsIn(set, 2);
    return Deviation{.missed_share = is_poor ? 0.5 : IsIn(set, 1) ? 0.02 : 0.0};
  });
  EXPECT_NE(IsIn(result.left_out, 1), IsIn(result.left_out, 2));
  EXPECT_TRUE(IsIn(result.left_out, 0));
  EXPECT_LE(result.deviation.missed_share, 0.1);
}

TEST(EffectSearch, PutsAllBackIfNothingElseHelps) {
  const auto result = Search(kTenPercent, [](Omissions set) {
    const int num_off = __builtin_popcount(set);
    return Deviation{.missed_share = num_off > 1 ? 0.9 : 0.03 * num_off};
  });
  EXPECT_LE(result.deviation.missed_share, 0.1);
  EXPECT_LE(__builtin_popcount(result.left_out), 1);
}

TEST(EffectSearch, KeepsAMarginForOtherFrames) {
  const auto result = Search(kTenPercent, MissedWithout(0.0, 0.09, 0.0));
  EXPECT_EQ(result.left_out, kFirst | kLast);
}

TEST(EffectSearch, AllowsLittleMoreThanAllEffectsReach) {
  // 0.015 is within 0.2 of the tolerance, twice as much is not.
  const auto result = Search(kTenPercent, MissedWithout(0.015, 0.5, 0.015, 0.3));
  EXPECT_EQ(result.left_out, kLast);
}

TEST(EffectSearch, KeepsWhatChangesAnythingAtNoTolerance) {
  const ToleranceSpec none{.range_m = 0.0,
                           .missed_share = 0.0,
                           .false_share = 0.0,
                           .thin_missed_share = 0.0,
                           .intensity = 0.0};
  EXPECT_EQ(Search(none, MissedWithout(0.0, 1e-6, 1e-6, 0.3)).left_out, kFirst);
}

TEST(EffectSearch, IsNotDeceivedByAChangeForTheBetter) {
  // By chance fewer echoes are missed without the first. That must not allow leaving out another.
  const auto result = Search(kTenPercent, MissedWithout(-0.05, 0.12, 0.0, 0.0));
  EXPECT_FALSE(IsIn(result.left_out, 1));
}

// A far bin with so many echoes of which so many are missed, and a near one with all the others.
Deviation OfTwoBins(std::uint64_t num_missed, std::uint64_t num) {
  FrameDifference difference;
  difference.reference_echoes = {100'000, 100'000 - num_missed};
  difference.parts = {
      {{ScenePart::Kind::kRangeBin, 0, "0 to 50 m"}, {100'000 - num, 100'000 - num}, {}, {}, {}},
      {{ScenePart::Kind::kRangeBin, 5, "250 to 300 m"}, {num, num - num_missed}, {}, {}, {}}};
  return DeviationOf(difference);
}

TEST(EffectSearch, KeepsWhatAFewEchoesFarAwayNeed) {
  const auto result =
      Search(kTenPercent, [](Omissions set) { return OfTwoBins(IsIn(set, 1) ? 40 : 0, 110); });
  EXPECT_LT(result.without[1].missed_share, 1e-3) << "nothing that the mean would show";
  EXPECT_EQ(result.left_out, kFirst | kLast);
}

TEST(EffectSearch, DoesNotTakeTwoEchoesForAProof) {
  const auto result =
      Search(kTenPercent, [](Omissions set) { return OfTwoBins(IsIn(set, 1) ? 1 : 0, 2); });
  EXPECT_EQ(result.left_out, kFirst | kDearest | kLast);
}

TEST(EffectSearch, MayNotMissMoreFarAwayWhereAllEffectsMissTooMuch) {
  const auto result = Search(kTenPercent, [](Omissions set) {
    return OfTwoBins(IsIn(set, 1) ? 600 : IsIn(set, 0) ? 305 : 300, 1000);
  });
  EXPECT_FALSE(IsWithin(result.deviation, kTenPercent));
  EXPECT_EQ(result.left_out, kFirst | kLast);
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

TEST(Deviation, IsBeyondWhereOnePartIs) {
  EXPECT_TRUE(IsWithin(OfTwoBins(3, 30), {}));
  const Deviation deviation = OfTwoBins(13, 30);
  EXPECT_FALSE(IsWithin(deviation, {}));
  const std::vector<PartDeviation> beyond = PartsBeyond(deviation, {});
  ASSERT_EQ(beyond.size(), 1U);
  EXPECT_EQ(beyond[0].part, "250 to 300 m");
  EXPECT_EQ(beyond[0].num_reference, 30U);
  EXPECT_NEAR(beyond[0].missed_share.value, 13.0 / 30.0, 1e-12);
}

TEST(Deviation, MayBeBeyondWhereThatOfAllEffectsIs) {
  EXPECT_TRUE(IsWithinOrAsFull(OfTwoBins(310, 1000), OfTwoBins(300, 1000), kTenPercent));
  EXPECT_FALSE(IsWithinOrAsFull(OfTwoBins(400, 1000), OfTwoBins(300, 1000), kTenPercent));
}

TEST(InstructionsOf, CountTheSubRaysOfTheFootprint) {
  const EffectSet footprint = EffectsOfRung(Fidelity::kFootprint);
  const BeamSpec sparse{.footprint_rays = 16};
  EXPECT_EQ(InstructionsOf(footprint, {}) - InstructionsOf(footprint, sparse),
            kInstructionsOfMoreSubRays);
  const EffectSet surface = EffectsOfRung(Fidelity::kSurface);
  EXPECT_EQ(InstructionsOf(surface, {}), InstructionsOf(surface, sparse));
}

TEST(InstructionsOf, CountTheShareOfBeamsThatHaveAWidth) {
  const EffectSet footprint = EffectsOfRung(Fidelity::kFootprint);
  EffectSet without = footprint;
  without.footprint = false;
  const BeamSpec of_persons{.footprint_of = {"person"}};
  const double none = InstructionsOf(without, {});
  EXPECT_EQ(InstructionsOf(without, of_persons), none);
  EXPECT_NEAR(
      InstructionsOf(footprint, of_persons),
      none + kInstructionsOfChoosing + kShareOfChosen * (InstructionsOf(footprint, {}) - none),
      1e-9);
}

// With 16 sub-rays the footprint saves no more than those cost; with 64, the others save the rest.
TEST(SavingOf, AddsUpToWhatTheFootprintCosts) {
  const EffectSet footprint = EffectsOfRung(Fidelity::kFootprint);
  EffectSet without = footprint;
  without.footprint = false;
  const BeamSpec sparse{.footprint_rays = 16};
  const double saving = SavingOf(*FindEffect("footprint"), footprint, {});
  EXPECT_EQ(saving, InstructionsOf(footprint, sparse) - InstructionsOf(without, sparse));
  EXPECT_EQ(saving + kInstructionsOfMoreSubRays,
            InstructionsOf(footprint, {}) - InstructionsOf(without, {}));
}

using Sums = EchoesByRange::Sums;

TEST(EchoesByRange, TellsTheNearestEchoOfAFiringFromItsOthers) {
  Frame frame;
  frame.Resize(1, 2, 2);
  frame.label = {7, 7, 7, 8};
  frame.true_range_m = {40.0F, 35.0F, 10.0F, 20.0F};
  frame.intensity = {0.1F, 0.2F, 0.5F, 0.9F};
  frame.outcome = {Outcome::kReturned, Outcome::kReturned, Outcome::kBelowThreshold,
                   Outcome::kReturned};
  EchoesByRange echoes(30.0);
  echoes.AddFrame(frame);
  echoes.AddFrame(frame);
  ASSERT_EQ(echoes.Of(7, 1).size(), 2U);
  EXPECT_EQ(echoes.Of(7, 1)[0].first, 1.0);
  EXPECT_EQ(echoes.Of(7, 1)[0].further, 1.0);
  EXPECT_NEAR(echoes.Of(7, 1)[1].intensity, 0.2, 1e-6);
  EXPECT_TRUE(echoes.Of(7, 0).empty());
  EXPECT_EQ(echoes.Of(8, 0)[1].first, 1.0);
  EXPECT_EQ(echoes.Places(), (std::vector<EchoesByRange::Place>{{7, 1}, {8, 0}}));
}

TEST(EchoesByRange, CountsNeighboursOnTheSameLabel) {
  Frame frame;
  frame.Resize(2, 3, 1);
  frame.label = {7, 7, 8, 7, 7, 7};
  frame.true_range_m = {10.0F, 10.05F, 10.0F, 10.0F, 11.0F, 11.0F};
  frame.outcome.assign(6, Outcome::kReturned);
  EchoesByRange echoes(30.0);
  echoes.AddFrame(frame);
  EXPECT_EQ(echoes.Of(7, 0)[0].neighbours, 3.0);
  EXPECT_EQ(echoes.Of(7, 0)[0].near_neighbours, 2.0);
  EXPECT_EQ(echoes.Of(8, 0)[0].neighbours, 0.0);
}

TEST(RelativeChange, HasAnIntervalFromTheFramesAgainstEachOther) {
  const std::vector<Sums> from = {{.first = 100, .intensity = 10}, {.first = 200, .intensity = 20}};
  const std::vector<Sums> doubled = {{.first = 200, .intensity = 40},
                                     {.first = 400, .intensity = 80}};
  EXPECT_DOUBLE_EQ(ChangeOfSum(from, doubled, &Sums::first).change, 1.0);
  EXPECT_NEAR(ChangeOfSum(from, doubled, &Sums::first).margin, 0.0, 1e-12);
  EXPECT_DOUBLE_EQ(ChangeOfIntensity(from, doubled).change, 1.0);
  EXPECT_NEAR(ChangeOfIntensity(from, doubled).margin, 0.0, 1e-12);
  // Shares of the frames: 1/3 and 2/3 before, 2/3 and 1/3 after.
  const std::vector<Sums> swapped = {{.first = 200, .intensity = 20},
                                     {.first = 100, .intensity = 10}};
  EXPECT_DOUBLE_EQ(ChangeOfSum(from, swapped, &Sums::first).change, 0.0);
  EXPECT_NEAR(ChangeOfSum(from, swapped, &Sums::first).margin, 1.96 * std::sqrt(2.0 / 9.0), 1e-12);
}

TEST(RelativeChange, OfHeightsIsThatOfTheirStandardDeviation) {
  // Two heights a frame: 1 m above and below the mean of 3 m, then 2 m above and below that of 5 m.
  const std::vector<Sums> from(2, {.num_surveyed = 2, .height_m = 6, .square_height_m2 = 20});
  const std::vector<Sums> wider(2, {.num_surveyed = 2, .height_m = 10, .square_height_m2 = 58});
  EXPECT_NEAR(ChangeOfHeights(from, wider).change, 1.0, 1e-12);
  EXPECT_NEAR(ChangeOfHeights(from, wider).margin, 0.0, 1e-12);
}

}  // namespace
}  // namespace railcast
