#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "core/rail/network/junction_rails.h"
#include "core/rail/network/network_draft.h"
#include "tests/core/rail/test_line.h"
#include "tests/core/rail/track/cut_rails.h"

namespace railcast {
namespace {

using testing::IsEmpty;

constexpr double kCrossing_m = 130.0;

double DegreesOf(double angle_rad) {
  return angle_rad * 180.0 / std::numbers::pi;
}

/// A straight track that comes from the left and crosses the alignment at kCrossing_m.
TrackSpec Across(double angle_rad) {
  return {.name = "across",
          .offset_m = kCrossing_m * std::tan(angle_rad),
          .elements = {{ElementType::kStraight, 250.0, std::nullopt}},
          .heading_deg = -DegreesOf(angle_rad)};
}

/// A line with a diamond of 1:n.
WorldSpec LineWithDiamond(WorldSpec line, double n) {
  line.tracks.push_back(Across(std::atan(1.0 / n)));
  line.diamond_crossings.push_back({{"main", "across"}, kCrossing_m});
  return line;
}

WorldSpec LevelArc(double length_m, double radius_m) {
  WorldSpec line = CantedArc(length_m, radius_m);
  line.alignment.speed_limits_kmph.clear();
  return line;
}

/// As Across(), but in an arc of 800 m that turns right and has that angle where it crosses.
constexpr double kArc_m = 800.0;
constexpr double kArcAngle_rad = 0.11;
TrackSpec AcrossInAnArc() {
  constexpr double kBefore_m = 60.0;
  const double begin_rad = kArcAngle_rad - kBefore_m / kArc_m;
  return {.name = "across",
          .offset_m = kArc_m * (std::cos(begin_rad) - std::cos(kArcAngle_rad)),
          .elements = {{ElementType::kArc, 2.0 * kBefore_m, -kArc_m}},
          .heading_deg = -DegreesOf(begin_rad),
          .start_s_m = kCrossing_m + kArc_m * (std::sin(begin_rad) - std::sin(kArcAngle_rad))};
}

WorldSpec LineWithDiamondInAnArc() {
  WorldSpec line = StraightLine(300.0);
  line.tracks.push_back(AcrossInAnArc());
  line.diamond_crossings.push_back({{"main", "across"}, kCrossing_m});
  return line;
}

CrossedRailPlaces PlacesOnRail(const TestLine& line, bool on_second, bool is_left) {
  const DiamondSite& site = line.network().diamonds.at(0);
  const auto places =
      PlacesOn({site, line.network().courses[site.first], line.network().courses[site.second]},
               on_second, is_left);
  return places.value();
}

constexpr double kClose_m = 1e-5;

TEST(Diamond, HasItsFrogsWhereTheGaugeLinesCross) {
  for (const double n : {4.0, 9.0, 20.0}) {
    const TestLine line(LineWithDiamond(StraightLine(300.0), n));
    const double half_rad = 0.5 * std::atan(1.0 / n);
    // The main track comes from the right. A rhombus of the gauge lines, with its acute corners on
    // the bisector.
    const CrossedRailPlaces left = PlacesOnRail(line, false, true);
    EXPECT_NEAR(left.acute_s_m, kCrossing_m - kHalf_m / std::tan(half_rad), kClose_m);
    EXPECT_NEAR(left.obtuse_s_m, kCrossing_m + kHalf_m * std::tan(half_rad), kClose_m);
    const CrossedRailPlaces right = PlacesOnRail(line, false, false);
    EXPECT_NEAR(right.acute_s_m, kCrossing_m + kHalf_m / std::tan(half_rad), kClose_m);
    EXPECT_NEAR(right.obtuse_s_m, kCrossing_m - kHalf_m * std::tan(half_rad), kClose_m);
    // Both tracks' rails meet at the same places.
    EXPECT_NEAR(PlacesOnRail(line, true, false).acute_s_m, left.acute_s_m, kClose_m);
    EXPECT_NEAR(PlacesOnRail(line, true, true).acute_s_m, right.acute_s_m, kClose_m);
    EXPECT_NEAR(PlacesOnRail(line, true, true).obtuse_s_m, left.obtuse_s_m, kClose_m);
    EXPECT_NEAR(line.network().diamonds[0].angle_rad, 2.0 * half_rad, 1e-9);
  }
}

TEST(Diamond, IsFoundWhereTracksCrossAtARoundChainage) {
  WorldSpec line = StraightLine(300.0);
  line.tracks.push_back(
      {.name = "across", .offsets_m = {{0.0, -4.0}, {100.0, -4.0}, {200.0, 4.0}}});
  line.diamond_crossings.push_back({{"main", "across"}, 150.0});
  const TestLine made(line);
  ASSERT_THAT(made.network().diamonds, testing::SizeIs(1));
  EXPECT_NEAR(made.network().diamonds[0].s_m, 150.0, 1e-6);
}

TEST(Diamond, HasItsFrogsWhereTheGaugeLinesCrossInAnArcToo) {
  const TestLine line(LineWithDiamondInAnArc());
  const double middle_s_m = kCrossing_m - kArc_m * std::sin(kArcAngle_rad);
  const double middle_d_m = -kArc_m * std::cos(kArcAngle_rad);
  const auto meets_at_m = [&](double radius_m, double d_m) {
    return middle_s_m + std::sqrt(radius_m * radius_m - std::pow(d_m - middle_d_m, 2));
  };
  const CrossedRailPlaces left = PlacesOnRail(line, false, true);
  EXPECT_NEAR(left.acute_s_m, meets_at_m(kArc_m - kHalf_m, kHalf_m), kClose_m);
  EXPECT_NEAR(left.obtuse_s_m, meets_at_m(kArc_m + kHalf_m, kHalf_m), kClose_m);
  const CrossedRailPlaces right = PlacesOnRail(line, false, false);
  EXPECT_NEAR(right.acute_s_m, meets_at_m(kArc_m + kHalf_m, -kHalf_m), kClose_m);
  EXPECT_NEAR(right.obtuse_s_m, meets_at_m(kArc_m - kHalf_m, -kHalf_m), kClose_m);
}

TEST(Diamond, LeavesAWayForFlangesOnBothTracks) {
  for (const double n : {4.0, 9.0, 20.0}) {
    const TestLine line(LineWithDiamond(StraightLine(300.0), n));
    for (const std::size_t track : {0U, 1U}) {
      ExpectFlangesFindAWay(line, {track, 85.0, 175.0},
                            "1:" + std::to_string(n) + " on " + std::to_string(track));
    }
  }
}

TEST(Diamond, LeavesAWayForFlangesInCurves) {
  const TestLine curved(LineWithDiamond(LevelArc(300.0, 500.0), 9.0));
  const TestLine arc(LineWithDiamondInAnArc());
  for (const std::size_t track : {0U, 1U}) {
    ExpectFlangesFindAWay(curved, {track, 100.0, 160.0}, "curved on " + std::to_string(track));
    ExpectFlangesFindAWay(arc, {track, 100.0, 160.0}, "arc on " + std::to_string(track));
  }
}

TEST(Diamond, HasFlangewaysOf44MillimetresInItsFrogs) {
  const TestLine line(LineWithDiamond(StraightLine(300.0), 9.0));
  const CrossedRailPlaces left = PlacesOnRail(line, false, true);
  const auto gap_below_left_rail_m = [&](double s_m) {
    const std::vector<double> places_m = CutRails(line, 0, s_m).At(-kGaugeDepth_m);
    return kHalf_m - *std::prev(std::ranges::lower_bound(places_m, kHalf_m - 0.005));
  };
  // The other rail's wing beside the acute nose, the check rail before the obtuse frog.
  EXPECT_NEAR(gap_below_left_rail_m(left.nose_s_m - 0.2), 0.044, 0.5e-3);
  EXPECT_NEAR(gap_below_left_rail_m(left.tip_s_m - 0.5), 0.044, 0.5e-3);
  // Opposite the acute frog, a check rail stands beside the right rail.
  const std::vector<double> places_m = CutRails(line, 0, left.nose_s_m).At(-kGaugeDepth_m);
  EXPECT_NEAR(*std::ranges::upper_bound(places_m, -kHalf_m + 0.005) + kHalf_m, 0.041, 0.5e-3);
}

TEST(Diamond, LeavesRunningSurfacesButForTheGapsOfItsFrogs) {
  const TestLine line(LineWithDiamond(StraightLine(300.0), 9.0));
  const BuiltTracks tracks(line);
  const CrossedRailPlaces left = PlacesOnRail(line, false, true);
  const auto carries = [&](double s_m) {
    // 12 mm behind the gauge face, where the head is 2 mm lower than its crown.
    return !CutRails(tracks, 0, s_m)
                .IsFree({Eigen::Vector2d(kHalf_m + 0.009, -0.004),
                         Eigen::Vector2d(kHalf_m + 0.012, 0.001)});
  };
  for (double s_m = 105.3; s_m < 155.0; s_m += 0.21) {
    const bool is_in_acute_gap = s_m > left.nose_s_m - 0.25 && s_m < left.throat_s_m + 0.05;
    const bool is_in_obtuse_gap = s_m > left.tip_s_m - 0.25 && s_m < left.obtuse_s_m + 0.05;
    if (is_in_acute_gap || is_in_obtuse_gap) continue;
    EXPECT_TRUE(carries(s_m)) << s_m;
  }
  EXPECT_FALSE(carries(0.5 * (left.tip_s_m + left.obtuse_s_m)));
}

TEST(Diamond, RestsOnLongBearersInPlaceOfSleepers) {
  const TestLine line(LineWithDiamond(StraightLine(300.0), 9.0));
  double longest_m = 0.0;
  int num_bearers = 0;
  for (int chunk_index = 1; chunk_index < 5; ++chunk_index) {
    for (const Placement& placement : line.Build(chunk_index).placements) {
      const Transform world_from_model =
          line.WorldFromChunk(chunk_index) * Transform(placement.chunk_from_model.matrix());
      const double from_middle_m = std::abs(world_from_model.translation().x() - kCrossing_m);
      if (placement.model == line.models().concrete_sleeper) {
        EXPECT_GE(from_middle_m, 9.0 * 2.7 - 0.6);
      } else if (placement.model->name == "bearer") {
        EXPECT_LE(from_middle_m, 9.0 * 2.7 + 0.6);
        longest_m = std::max(longest_m, placement.model->Bounds().sizes().y());
        ++num_bearers;
      }
    }
  }
  EXPECT_NEAR(longest_m, 5.3, 0.11);
  EXPECT_EQ(num_bearers, 82);  // Multiples of 0.6 m within 24.5 m of the middle.
}

TEST(Diamond, LetsItsTracksBeCloseNearIt) {
  const WorldSpec world = LineWithDiamond(StraightLine(300.0), 9.0);
  WorldFaults faults;
  const NetworkDraft network = DraftNetwork(world, 300.0, faults);
  CheckNetwork(world, network, Alignment(world.alignment), faults);
  EXPECT_THAT(faults.errors.lines(), IsEmpty());
  const ChainageRange close = CloseTo(network.diamonds.at(0), network, 3.0);
  EXPECT_NEAR(close.begin_s_m, kCrossing_m - 27.0, 0.5);
  EXPECT_NEAR(close.end_s_m, kCrossing_m + 27.0, 0.5);
}

}  // namespace
}  // namespace railcast
