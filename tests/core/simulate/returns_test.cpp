// Tests every return mode on hand-made echoes.
#include "core/simulate/returns.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "railcast/outcome.h"

namespace railcast {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

struct HandMade {
  float range_m{};
  float power_ratio{};
  Outcome outcome = Outcome::kReturned;
  std::uint32_t surface = 1;
  std::uint32_t clutter = kNoClutter;
  float busy_m = 0.0F;
  float share = 0.5F;
};

void Fill(const HandMade& echo, DetectTile& tile, std::size_t lane) {
  const bool has_point = HasPoint(echo.outcome);
  tile.surface[lane] = echo.surface;
  tile.true_range_m[lane] = echo.range_m;
  tile.incidence_rad[lane] = 0.25F;
  tile.share[lane] = echo.share;
  tile.outcome[lane] = static_cast<std::uint32_t>(echo.outcome);
  tile.clutter[lane] = echo.clutter;
  tile.intensity[lane] = 0.125F;
  tile.power_ratio[lane] = echo.power_ratio;
  tile.busy_m[lane] = echo.busy_m;
  tile.range_m[lane] = has_point ? echo.range_m : kNaN;
  tile.x[lane] = tile.y[lane] = tile.z[lane] = tile.range_m[lane];
}

std::vector<Surface> FiveSurfaces() {
  std::vector<Surface> surfaces(5);
  for (std::uint32_t i = 1; i < 5; ++i) {
    surfaces[i] = {.label = 10 + i, .instance = 20 + i, .material = 3};
  }
  return surfaces;
}

// A frame of 2 rows and 2 columns. Firing 2 (row 1, column 0) has the echoes, the others have none.
Frame StoreOne(const ReturnRule& rule,
               const std::vector<HandMade>& hand_made,
               bool has_shares = true) {
  auto echoes = std::make_unique<EchoTiles>();
  echoes->first.num_rays = 4;
  for (std::size_t lane = 0; lane < 4; ++lane) {
    Fill({kNaN, kNaN, Outcome::kNoSurface, 0}, echoes->first, lane);
  }
  Fill(hand_made.front(), echoes->first, 2);
  for (std::size_t i = 1; i < hand_made.size(); ++i) {
    const auto [tile, lane] = echoes->Add(2, static_cast<std::uint32_t>(i));
    Fill(hand_made[i], tile, lane);
  }
  Frame frame;
  frame.Resize(2, 2, NumReturns(rule.mode));
  const std::uint32_t slots[] = {0, 1, 2, 3};
  ReturnStore(rule, has_shares).Store(*echoes, FiveSurfaces(), {slots, 4}, frame);
  return frame;
}

// Surfaces of the slots of row 1, column 0; 0 = none.
std::vector<std::uint32_t> Chosen(const ReturnRule& rule, const std::vector<HandMade>& hand_made) {
  const Frame frame = StoreOne(rule, hand_made);
  const std::size_t first = std::size_t{frame.width()};  // row x width + 0 x returns
  std::vector<std::uint32_t> surfaces;
  for (std::size_t r = 0; r < frame.returns; ++r) {
    const std::uint32_t label = frame.label[first + r];
    surfaces.push_back(label == 0 ? 0 : label - 10);
  }
  return surfaces;
}

using Surfaces = std::vector<std::uint32_t>;

const std::vector<HandMade> kFour = {{40.0F, 3.0F, Outcome::kReturned, 1},
                                     {10.0F, 2.0F, Outcome::kReturned, 2},
                                     {20.0F, 9.0F, Outcome::kReturned, 3},
                                     {30.0F, 5.0F, Outcome::kReturned, 4}};

TEST(Returns, ReportTheEchoThatTheModeAsksFor) {
  EXPECT_EQ(Chosen({.mode = ReturnMode::kStrongest}, kFour), (Surfaces{3}));
  EXPECT_EQ(Chosen({.mode = ReturnMode::kFirst}, kFour), (Surfaces{2}));
  EXPECT_EQ(Chosen({.mode = ReturnMode::kLast}, kFour), (Surfaces{1}));
  EXPECT_EQ(Chosen({.mode = ReturnMode::kDual}, kFour), (Surfaces{3, 1}));
  EXPECT_EQ(Chosen({.mode = ReturnMode::kTriple}, kFour), (Surfaces{3, 1, 2}));
}

TEST(Returns, GiveTheSecondStrongestWhereTheStrongestIsLast) {
  const std::vector<HandMade> echoes = {{40.0F, 9.0F, Outcome::kReturned, 1},
                                        {10.0F, 5.0F, Outcome::kReturned, 2},
                                        {20.0F, 2.0F, Outcome::kReturned, 3}};
  EXPECT_EQ(Chosen({.mode = ReturnMode::kDual}, echoes), (Surfaces{1, 2}));
  EXPECT_EQ(Chosen({.mode = ReturnMode::kTriple}, echoes), (Surfaces{1, 2, 3}));
}

TEST(Returns, GiveTheNextStrongestWhereTheFirstIsTakenAlready) {
  // The first echo is the strongest, so the third slot holds the strongest of the rest.
  const std::vector<HandMade> echoes = {{10.0F, 9.0F, Outcome::kReturned, 1},
                                        {20.0F, 2.0F, Outcome::kReturned, 2},
                                        {30.0F, 5.0F, Outcome::kReturned, 3},
                                        {40.0F, 4.0F, Outcome::kReturned, 4}};
  EXPECT_EQ(Chosen({.mode = ReturnMode::kTriple}, echoes), (Surfaces{1, 4, 3}));
}

TEST(Returns, DoNotDependOnTheOrderOfTheEchoes) {
  std::vector<HandMade> echoes = kFour;
  std::ranges::sort(echoes, {}, &HandMade::surface);
  int num = 0;
  do {
    EXPECT_EQ(Chosen({.mode = ReturnMode::kDual}, echoes), (Surfaces{3, 1}));
    EXPECT_EQ(Chosen({.mode = ReturnMode::kTriple}, echoes), (Surfaces{3, 1, 2}));
    ++num;
  } while (std::ranges::next_permutation(echoes, {}, &HandMade::surface).found);
  EXPECT_EQ(num, 24);
}

TEST(Returns, LeaveSlotsEmptyWhereNothingMoreCameBack) {
  const Frame frame = StoreOne({.mode = ReturnMode::kTriple}, {{10.0F, 9.0F}, {20.0F, 5.0F}});
  const std::size_t first = std::size_t{frame.width()};
  EXPECT_EQ(frame.outcome[first], Outcome::kReturned);
  EXPECT_EQ(frame.outcome[first + 1], Outcome::kReturned);
  EXPECT_EQ(frame.outcome[first + 2], Outcome::kNoFurtherEcho);
  for (const auto* values :
       {&frame.x, &frame.y, &frame.z, &frame.intensity, &frame.power_ratio, &frame.range_m,
        &frame.true_range_m, &frame.incidence_rad, &frame.footprint_share}) {
    EXPECT_TRUE(std::isnan((*values)[first + 2]));
  }
  EXPECT_EQ(frame.label[first + 2], 0U);
  EXPECT_EQ(frame.instance[first + 2], 0U);
  EXPECT_EQ(frame.material[first + 2], 0U);
  for (std::size_t r = 0; r < 3; ++r) EXPECT_EQ(frame.return_count[first + r], 2);
}

TEST(Returns, StandAtRowTimesWidthPlusColumnTimesReturns) {
  const Frame frame = StoreOne({.mode = ReturnMode::kDual}, kFour);
  ASSERT_EQ(frame.num_slots(), 8U);
  for (std::size_t slot = 0; slot < 8; ++slot) {
    // Row 1, column 0: 1 x 4 + 0 x 2 + r.
    EXPECT_EQ(HasPoint(frame.outcome[slot]), slot == 4 || slot == 5) << slot;
    const bool is_second_of_none = slot % 2 == 1 && slot != 5;
    EXPECT_EQ(frame.outcome[slot] == Outcome::kNoFurtherEcho, is_second_of_none) << slot;
  }
  EXPECT_EQ(frame.outcome[0], Outcome::kNoSurface);
  EXPECT_TRUE(std::isnan(frame.footprint_share[0]));
  EXPECT_EQ(frame.return_count[0], 0);
}

TEST(Returns, LetTheFirstSlotSayWhatAFiringWithoutReturnMissed) {
  // The strongest surface below the threshold, neither the stronger drop nor the first echo in the
  // list.
  const std::vector<HandMade> missed = {{40.0F, 0.2F, Outcome::kBelowThreshold, 1},
                                        {10.0F, 0.6F, Outcome::kBelowThreshold, 2},
                                        {5.0F, 0.9F, Outcome::kBelowThreshold, 0, 23}};
  const Frame frame = StoreOne({.mode = ReturnMode::kDual}, missed);
  EXPECT_EQ(frame.outcome[4], Outcome::kBelowThreshold);
  EXPECT_EQ(frame.label[4], 12U);
  EXPECT_EQ(frame.true_range_m[4], 10.0F);
  EXPECT_EQ(frame.return_count[4], 0);
  EXPECT_EQ(frame.outcome[5], Outcome::kNoFurtherEcho);
}

TEST(Returns, KeepTheVehiclesOwnBodyWhereNoSurfaceWasTooWeak) {
  EXPECT_EQ(StoreOne({.mode = ReturnMode::kStrongest},
                     {{0.3F, 80.0F, Outcome::kEgo}, {1.0F, 2.0F, Outcome::kSensorDropout, 0, 23}})
                .outcome[2],
            Outcome::kEgo);
}

TEST(Returns, SayOfALostFiringWhatFilledMostOfItsBeam) {
  std::vector<HandMade> echoes = {{10.0F, 9.0F, Outcome::kSensorDropout, 1},
                                  {20.0F, 2.0F, Outcome::kSensorDropout, 2},
                                  {5.0F, 2.0F, Outcome::kSensorDropout, 3, 7}};
  echoes[0].share = 0.2F;
  echoes[1].share = 0.8F;
  echoes[2].share = 1.0F;
  EXPECT_EQ(Chosen({.mode = ReturnMode::kStrongest}, echoes), (Surfaces{2}));
  echoes[0].share = 0.8F;
  EXPECT_EQ(Chosen({.mode = ReturnMode::kStrongest}, echoes), (Surfaces{1}));
}

// Fog that was too weak says nothing of the surface behind it, which the sensor has missed.
TEST(Returns, DoNotSayThatEchoesFromTheAirWereMissed) {
  EXPECT_EQ(
      StoreOne({.mode = ReturnMode::kStrongest}, {{40.0F, 0.4F, Outcome::kSensorDropout, 1},
                                                  {7.0F, 0.6F, Outcome::kBelowThreshold, 0, 25}})
          .outcome[2],
      Outcome::kSensorDropout);
}

TEST(Returns, PreferAnyDetectedEchoToTheLostSurface) {
  const Frame frame = StoreOne(
      {.mode = ReturnMode::kLast},
      {{40.0F, 0.9F, Outcome::kBelowThreshold, 1}, {3.0F, 1.5F, Outcome::kClutter, 0, 23}});
  EXPECT_EQ(frame.outcome[2], Outcome::kClutter);
  EXPECT_EQ(frame.label[2], 23U);
  EXPECT_EQ(frame.instance[2], 0U);
  EXPECT_EQ(frame.material[2], 0U);
  EXPECT_TRUE(std::isnan(frame.incidence_rad[2]));
  EXPECT_EQ(frame.range_m[2], 3.0F);
}

TEST(Returns, KeepAllFieldsOfASurface) {
  const Frame frame = StoreOne({.mode = ReturnMode::kStrongest}, kFour);
  EXPECT_EQ(frame.range_m[2], 20.0F);
  EXPECT_EQ(frame.true_range_m[2], 20.0F);
  EXPECT_EQ(frame.x[2], 20.0F);
  EXPECT_EQ(frame.power_ratio[2], 9.0F);
  EXPECT_EQ(frame.intensity[2], 0.125F);
  EXPECT_EQ(frame.incidence_rad[2], 0.25F);
  EXPECT_EQ(frame.instance[2], 23U);
  EXPECT_EQ(frame.material[2], 3);
  EXPECT_EQ(frame.footprint_share[2], 0.5F);
  // Without shares, the field is left unchanged.
  EXPECT_EQ(StoreOne({.mode = ReturnMode::kStrongest}, kFour, false).footprint_share[2], 0.0F);
}

constexpr ReturnRule kSaturating{.mode = ReturnMode::kTriple, .saturation_ratio = 100.0F};

HandMade Pulse(float range_m, float power_ratio, std::uint32_t surface, float busy_m) {
  return {range_m, power_ratio, Outcome::kReturned, surface, kNoClutter, busy_m};
}

// The saturated echo at 10 m falls below the threshold at 11.5 m, where that at 12 m begins if it
// is above the threshold for 0.5 m on either side.
TEST(SaturatedReturns, AreOneWithWhatTheyTouch) {
  const HandMade strong = Pulse(10.0F, 100.0F, 1, 1.5F);
  EXPECT_EQ(Chosen(kSaturating, {strong, Pulse(12.0F, 5.0F, 2, 0.5F)}), (Surfaces{1, 0, 0}));
  EXPECT_EQ(Chosen(kSaturating, {strong, Pulse(12.0F, 5.0F, 2, 0.49F)}), (Surfaces{1, 2, 0}));
  EXPECT_EQ(Chosen(kSaturating, {Pulse(8.0F, 5.0F, 2, 0.5F), strong}), (Surfaces{1, 0, 0}));
  EXPECT_EQ(Chosen(kSaturating, {Pulse(8.0F, 5.0F, 2, 0.49F), strong}), (Surfaces{1, 2, 0}));
}

TEST(SaturatedReturns, AreRepresentedByTheLongest) {
  const std::vector<HandMade> echoes = {Pulse(10.0F, 100.0F, 1, 1.5F),
                                        Pulse(12.0F, 100.0F, 2, 1.7F)};
  EXPECT_EQ(Chosen(kSaturating, echoes), (Surfaces{2, 0, 0}));
}

TEST(SaturatedReturns, JoinChains) {
  const std::vector<HandMade> echoes = {Pulse(10.0F, 5.0F, 1, 0.5F), Pulse(10.9F, 6.0F, 2, 0.5F),
                                        Pulse(12.5F, 100.0F, 3, 1.2F), Pulse(20.0F, 5.0F, 4, 0.5F)};
  EXPECT_EQ(Chosen(kSaturating, echoes), (Surfaces{3, 4, 0}));
}

TEST(SaturatedReturns, LeaveEchoesBelowTheSaturationApart) {
  const std::vector<HandMade> echoes = {Pulse(10.0F, 99.0F, 1, 1.5F), Pulse(11.0F, 5.0F, 2, 0.5F)};
  EXPECT_EQ(Chosen(kSaturating, echoes), (Surfaces{1, 2, 0}));
  EXPECT_EQ(Chosen({.mode = ReturnMode::kTriple},
                   {Pulse(10.0F, 100.0F, 1, 1.5F), Pulse(11.0F, 5.0F, 2, 0.5F)}),
            (Surfaces{1, 2, 0}));
}

// Four echoes 0.9 m apart before a receiver that is blind for 8 ns, that is 1.199 m: after the echo
// at 10.0 m the one at 10.9 m is not seen, that at 11.8 m is, that at 12.7 m is not.
TEST(DeadTime, HidesTheEchoesThatComeWhileTheReceiverIsBlind) {
  constexpr float kDead_m = 1.199F;
  const std::vector<HandMade> echoes = {{12.7F, 4.0F, Outcome::kReturned, 4},
                                        {10.9F, 9.0F, Outcome::kReturned, 2},
                                        {10.0F, 2.0F, Outcome::kReturned, 1},
                                        {11.8F, 3.0F, Outcome::kReturned, 3}};
  EXPECT_EQ(Chosen({ReturnMode::kStrongest, kDead_m}, echoes), (Surfaces{3}));
  EXPECT_EQ(Chosen({ReturnMode::kFirst, kDead_m}, echoes), (Surfaces{1}));
  EXPECT_EQ(Chosen({ReturnMode::kLast, kDead_m}, echoes), (Surfaces{3}));
  EXPECT_EQ(Chosen({ReturnMode::kDual, kDead_m}, echoes), (Surfaces{3, 1}));
  EXPECT_EQ(Chosen({ReturnMode::kTriple, kDead_m}, echoes), (Surfaces{3, 1, 0}));
  EXPECT_EQ(Chosen({ReturnMode::kDual}, echoes), (Surfaces{2, 4}));
}

TEST(DeadTime, EndsAtItsLengthExactly) {
  const auto last_of = [](float dead_length_m) {
    return Chosen({ReturnMode::kLast, dead_length_m},
                  {{10.0F, 2.0F, Outcome::kReturned, 1}, {11.5F, 2.0F, Outcome::kReturned, 2}});
  };
  EXPECT_EQ(last_of(1.5F), (Surfaces{2}));
  EXPECT_EQ(last_of(1.5000001F), (Surfaces{1}));
}

TEST(DeadTime, BeginsWithDetectedEchoesOnly) {
  EXPECT_EQ(Chosen({ReturnMode::kFirst, 2.0F}, {{10.0F, 0.5F, Outcome::kBelowThreshold, 1},
                                                {11.0F, 2.0F, Outcome::kReturned, 2}}),
            (Surfaces{2}));
}

TEST(NumReturns, IsHowManyAModeReports) {
  EXPECT_EQ(NumReturns(ReturnMode::kLast), 1U);
  EXPECT_EQ(NumReturns(ReturnMode::kDual), 2U);
  EXPECT_EQ(NumReturns(ReturnMode::kTriple), 3U);
}

}  // namespace
}  // namespace railcast
