#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/rail/line/rail_section.h"
#include "core/rail/network/junction_rails.h"
#include "core/rail/network/turnout_place.h"
#include "core/rail/track/track_structure.h"
#include "tests/core/rail/test_line.h"
#include "tests/core/rail/track/cut_rails.h"

namespace railcast {
namespace {

constexpr double kTurnoutBegins_m = 60.0;

/// A straight line of 300 m with a siding that leaves it at 60 m.
WorldSpec LineWithTurnout(TurnoutType type, double offset_m, TurnoutPosition position) {
  WorldSpec spec = StraightLine(300.0);
  spec.tracks.push_back({.name = "siding",
                         .offset_m = offset_m,
                         .begin = TurnoutSpec{"main", kTurnoutBegins_m, type, {}, position}});
  return spec;
}

/// As above, but the siding joins the line at 240 m, and so the turnout opens the other way.
WorldSpec LineWithTrailingTurnout(TurnoutType type, double offset_m, TurnoutPosition position) {
  WorldSpec spec = StraightLine(300.0);
  TrackSpec siding{.name = "siding", .offset_m = offset_m};
  siding.end = TurnoutSpec{"main", 240.0, type, {}, position};
  spec.tracks.push_back(siding);
  return spec;
}

TEST(Turnout, LeavesAWayForFlangesOnTheRouteThatItIsSetFor) {
  for (const TurnoutType type : kTurnoutTypes) {
    for (const double offset_m : {-4.5, 4.5}) {
      const std::string what(NameOf(type));
      ExpectFlangesFindAWay(TestLine(LineWithTurnout(type, offset_m, TurnoutPosition::kStraight)),
                            {0, 50.5, 99.5}, what + " straight");
      ExpectFlangesFindAWay(TestLine(LineWithTurnout(type, offset_m, TurnoutPosition::kDiverging)),
                            {1, 50.5, 99.5}, what + " diverging");
    }
  }
}

TEST(Turnout, BlocksAFlangeOnTheRouteThatItIsNotSetFor) {
  const TestLine line(LineWithTurnout(TurnoutType::k9_300, 4.5, TurnoutPosition::kDiverging));
  // The straight blade, on the left, stands off the stock rail in the way of the left flange.
  const CutRails rails(line, 0, 63.0);
  EXPECT_FALSE(rails.IsFree(Eigen::AlignedBox2d(Eigen::Vector2d(0.45, -0.028),
                                                Eigen::Vector2d(kHalf_m - 0.002, -0.008))));
}

/// The point at which the inner gauge lines cross: that of the straight at half a gauge, and that
/// of the branch, an arc of radius R + half a gauge about (0, R) that ends after the turn.
double FrogByClosedForm_m(const TurnoutGeometry& turnout) {
  const double radius_m = turnout.radius_m + kHalf_m;
  const double on_arc_m = std::sqrt(radius_m * radius_m - std::pow(turnout.radius_m - kHalf_m, 2));
  if (on_arc_m <= radius_m * std::sin(turnout.angle_rad)) return on_arc_m;
  const double end_x_m = radius_m * std::sin(turnout.angle_rad);
  const double end_y_m = turnout.radius_m - radius_m * std::cos(turnout.angle_rad);
  return end_x_m + (kHalf_m - end_y_m) / std::tan(turnout.angle_rad);
}

TEST(Turnout, HasItsFrogWhereTheGaugeLinesCross) {
  for (const TurnoutType type : kTurnoutTypes) {
    for (const double offset_m : {-4.5, 4.5}) {
      const TestLine line(LineWithTurnout(type, offset_m, TurnoutPosition::kStraight));
      const ChunkContext context = line.Context(1);
      ASSERT_EQ(context.turnouts.size(), 1U);
      const TurnoutSite& site = context.turnouts[0].site;
      const FrogPoint frog = FrogOf({site, context.tracks[0], context.tracks[1]});
      const TurnoutGeometry geometry = GeometryOf(type);
      EXPECT_NEAR(frog.through_s_m - kTurnoutBegins_m, FrogByClosedForm_m(geometry), 1e-5);
      // The frog of the shortest turnout is straight and has its nominal angle.
      if (type == TurnoutType::k9_190) {
        EXPECT_NEAR(frog.angle_rad, geometry.angle_rad, 1e-9);
      }
      EXPECT_LE(frog.angle_rad, geometry.angle_rad + 1e-9);
      EXPECT_GT(frog.angle_rad, 0.8 * geometry.angle_rad);
    }
  }
}

TEST(Turnout, OpensOneBladeBySixteenCentimetresAtItsTip) {
  for (const auto position : {TurnoutPosition::kStraight, TurnoutPosition::kDiverging}) {
    const TestLine line(LineWithTurnout(TurnoutType::k12_500, 4.5, position));
    const ChunkContext context = line.Context(1);
    const TurnoutSite& site = context.turnouts[0].site;
    int num_open = 0;
    for (const TurnoutRail& rail : RailsOf({site, context.tracks[0], context.tracks[1]})) {
      if (rail.role != RailRole::kBlade) continue;
      const bool is_open = rail.follows_branch == (position == TurnoutPosition::kStraight);
      EXPECT_NEAR(std::abs(rail.aside_m(rail.range.begin_s_m)), is_open ? 0.160 : 0.0, 1e-6);
      EXPECT_NEAR(rail.aside_m(rail.range.end_s_m), 0.0, 1e-6);
      EXPECT_NEAR(rail.width_m(rail.range.begin_s_m), 0.003, 1e-5);
      num_open += is_open ? 1 : 0;
    }
    EXPECT_EQ(num_open, 1);
  }
}

TEST(Turnout, HasFlangewaysBesideNoseAndCheckRails) {
  const TestLine line(LineWithTurnout(TurnoutType::k9_190, 4.5, TurnoutPosition::kStraight));
  const double nose_s_m = kTurnoutBegins_m + FrogByClosedForm_m(GeometryOf(TurnoutType::k9_190));
  const std::vector<double> places_m = CutRails(line, 0, nose_s_m + 0.5).At(-kGaugeDepth_m);
  // To the right of the nose the wing rail, and to the left of the right stock rail its check rail.
  const auto below = [&](double y_m) {
    return *std::prev(std::lower_bound(places_m.begin(), places_m.end(), y_m));
  };
  const auto above = [&](double y_m) {
    return *std::upper_bound(places_m.begin(), places_m.end(), y_m);
  };
  EXPECT_NEAR(kHalf_m - below(kHalf_m - 0.005), kFrogFlangeway_m, 0.5e-3);
  EXPECT_NEAR(above(-kHalf_m + 0.005) + kHalf_m, kCheckFlangeway_m, 0.5e-3);
}

TEST(Turnout, LiesMirroredWhereItOpensAgainstTheChainage) {
  const TestLine ahead(LineWithTurnout(TurnoutType::k9_300, 4.5, TurnoutPosition::kStraight));
  const TestLine back(
      LineWithTrailingTurnout(TurnoutType::k9_300, 4.5, TurnoutPosition::kStraight));
  for (const double along_m : {0.5, 4.0, 9.0, 15.0, 27.0, 29.0, 29.6, 32.0}) {
    const std::vector<double> of_ahead =
        CutRails(ahead, 0, kTurnoutBegins_m + along_m).At(-kGaugeDepth_m);
    const std::vector<double> of_back = CutRails(back, 0, 240.0 - along_m).At(-kGaugeDepth_m);
    ASSERT_EQ(of_ahead.size(), of_back.size()) << along_m;
    for (std::size_t i = 0; i < of_ahead.size(); ++i) {
      EXPECT_NEAR(of_ahead[i], of_back[i], 1.5e-3) << along_m;
    }
  }
}

TEST(Turnout, RestsOnLongBearersInPlaceOfSleepers) {
  const TestLine line(LineWithTurnout(TurnoutType::k9_300, 4.5, TurnoutPosition::kStraight));
  double longest_m = 0.0;
  for (int chunk_index = 1; chunk_index < 3; ++chunk_index) {
    Chunk chunk;
    AddTracks(line.Context(chunk_index), line.models(), chunk);
    for (const Placement& placement : chunk.placements) {
      const Transform world_from_model =
          line.WorldFromChunk(chunk_index) * Transform(placement.chunk_from_model.matrix());
      const double s_m = world_from_model.translation().x();
      if (placement.model == line.models().concrete_sleeper) {
        // Both tracks have sleepers of their own only where these do not touch.
        EXPECT_TRUE(s_m < kTurnoutBegins_m || s_m > kTurnoutBegins_m + 35.0) << s_m;
      } else if (placement.model->name == "bearer") {
        longest_m = std::max(longest_m, placement.model->Bounds().sizes().y());
      }
    }
  }
  EXPECT_NEAR(longest_m, 5.3, 0.11);
}

TEST(PlanedSection, IsLowerWhereLessThanHalfOfTheHeadIsLeft) {
  const auto top_of = [](const RailSection& section) {
    double top_m = -1.0;
    for (const Eigen::Vector2d& point : section.outline_m) top_m = std::max(top_m, point.y());
    return top_m;
  };
  EXPECT_NEAR(top_of(PlanedSection(true, 0.060)), 0.0, 1e-6);
  // The gauge corner has a radius of 13 mm: at 3 mm from the gauge face it is well below the crown.
  EXPECT_LT(top_of(PlanedSection(true, 0.003)), -0.005);
  EXPECT_GT(top_of(PlanedSection(true, 0.003)), -0.015);
  const RailSection left = PlanedSection(true, 0.02);
  const RailSection right = PlanedSection(false, 0.02);
  for (std::size_t i = 0; i < left.outline_m.size(); ++i) {
    const Eigen::Vector2d& mirrored = right.outline_m[left.outline_m.size() - 1 - i];
    EXPECT_EQ(left.outline_m[i].x(), -mirrored.x());
    EXPECT_LE(left.outline_m[i].x(), kHalf_m + 0.02 + 1e-12);
  }
}

}  // namespace
}  // namespace railcast
