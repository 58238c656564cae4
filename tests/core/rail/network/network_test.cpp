#include "core/rail/network/network_draft.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/rail/network/turnout_place.h"
#include "tests/core/rail/test_line.h"

namespace railcast {
namespace {

using testing::ElementsAre;

/// Rounding of offsets that are integrated in steps of up to 10 m.
constexpr double kExact_m = 1e-9;

WorldSpec StraightWith(std::vector<TrackSpec> tracks) {
  WorldSpec world = StraightLine(1000.0);
  for (TrackSpec& track : tracks) world.tracks.push_back(std::move(track));
  return world;
}

TurnoutSpec On(const std::string& track, double s_m, TurnoutType type = TurnoutType::k9_300) {
  return {.track = track, .s_m = s_m, .turnout = type, .side = {}, .position = {}};
}

TrackCourse CourseOf(const WorldSpec& world, std::size_t track) {
  return MakeNetwork(world, 1000.0).courses[track];
}

std::vector<std::string> NetworkFaults(const WorldSpec& world) {
  WorldFaults faults;
  static_cast<void>(DraftNetwork(world, 1000.0, faults));
  return faults.errors.lines();
}

TEST(Network, LeadsABranchAlongTheArcOfItsTurnout) {
  const TrackCourse siding =
      CourseOf(StraightWith({{.name = "siding", .offset_m = 4.5, .begin = On("main", 300.0)}}), 1);
  EXPECT_EQ(siding.begin_s_m(), 300.0);
  EXPECT_EQ(siding.end_s_m(), 1000.0);
  for (const double x_m : {0.0, 5.0, 21.0, 33.0}) {
    // A circle of 300 m that touches the main axis at the turnout's beginning.
    const TrackOffset offset = siding.OffsetAt(300.0 + x_m);
    EXPECT_NEAR(offset.d_m, 300.0 - std::sqrt(300.0 * 300.0 - x_m * x_m), kExact_m) << x_m;
    EXPECT_NEAR(offset.slope, x_m / std::sqrt(300.0 * 300.0 - x_m * x_m), kExact_m) << x_m;
    EXPECT_NEAR(offset.curvature_per_m(), 1.0 / 300.0, 1e-12) << x_m;
  }
}

TEST(Network, LeadsABranchOnAtTheTurnoutsAngleAndBackToItsOffset) {
  const TrackCourse siding = CourseOf(
      StraightWith(
          {{.name = "siding", .offset_m = -6.0, .begin = On("main", 300.0, TurnoutType::k9_190)}}),
      1);
  const TurnoutGeometry turnout = GeometryOf(TurnoutType::k9_190);
  // From the point where the tangents meet, the branch runs at the angle.
  const double meet_s_m = 300.0 + turnout.tangent_m;
  const TrackOffset offset = siding.OffsetAt(meet_s_m + 30.0);
  EXPECT_NEAR(offset.d_m, -30.0 / 9.0, kExact_m);
  EXPECT_NEAR(offset.slope, -1.0 / 9.0, 1e-12);
  // The curve back is as long as the turnout's arc, about the point 54 m behind the meeting point.
  const double parallel_s_m = meet_s_m + 6.0 * 9.0 + turnout.tangent_m;
  EXPECT_LT(siding.OffsetAt(parallel_s_m - 0.1).slope, 0.0);
  EXPECT_EQ(siding.OffsetAt(parallel_s_m + 1e-6).slope, 0.0);
  EXPECT_EQ(siding.OffsetAt(parallel_s_m + 1e-6).d_m, -6.0);
}

TEST(Network, LeadsALoopBackThroughATurnoutThatOpensAgainstTheChainage) {
  const WorldSpec world = StraightWith(
      {{.name = "loop", .offset_m = 4.5, .begin = On("main", 300.0), .end = On("main", 700.0)}});
  const Network network = MakeNetwork(world, 1000.0);
  const TrackCourse& loop = network.courses[1];
  for (const double x_m : {0.0, 10.0, 33.0, 50.0, 80.0}) {
    const TrackOffset out = loop.OffsetAt(300.0 + x_m);
    const TrackOffset back = loop.OffsetAt(700.0 - x_m);
    EXPECT_NEAR(out.d_m, back.d_m, kExact_m) << x_m;
    EXPECT_NEAR(out.slope, -back.slope, 1e-12) << x_m;
    EXPECT_NEAR(out.bend_per_m, back.bend_per_m, 1e-12) << x_m;
  }
  ASSERT_EQ(network.turnouts.size(), 2U);
  EXPECT_TRUE(network.turnouts[0].opens_ahead());
  EXPECT_FALSE(network.turnouts[1].opens_ahead());
  EXPECT_NEAR(network.turnouts[1].end_s_m, 700.0 - GeometryOf(TurnoutType::k9_300).length_m,
              kExact_m);
  EXPECT_EQ(network.turnouts[1].side, TrackSide::kLeft);
}

TEST(Network, FindsTheEndOfACrossover) {
  const WorldSpec world =
      StraightWith({{.name = "second", .offset_m = -4.0},
                    {.name = "crossover",
                     .begin = On("main", 100.0, TurnoutType::k12_500),
                     .end = TurnoutSpec{"second", {}, TurnoutType::k12_500, {}, {}}}});
  const Network network = MakeNetwork(world, 1000.0);
  const TurnoutGeometry turnout = GeometryOf(TurnoutType::k12_500);
  // The tangents of both turnouts are one line at 1:12.
  const double end_s_m = 100.0 + 2.0 * turnout.tangent_m + 4.0 * 12.0;
  EXPECT_NEAR(network.courses[2].end_s_m(), end_s_m, kExact_m);
  EXPECT_NEAR(network.courses[2].OffsetAt(0.5 * (100.0 + end_s_m)).d_m, -2.0, kExact_m);
  EXPECT_NEAR(network.courses[2].OffsetAt(end_s_m).d_m, -4.0, kExact_m);
  EXPECT_NEAR(network.courses[2].OffsetAt(end_s_m).slope, 0.0, 1e-12);
  ASSERT_EQ(network.turnouts.size(), 2U);
  EXPECT_EQ(network.turnouts[0].side, TrackSide::kRight);
  EXPECT_EQ(network.turnouts[1].track, 1U);
  EXPECT_EQ(network.turnouts[1].side, TrackSide::kLeft);
}

TEST(Network, WidensTheSpacingByAnSCurve) {
  WorldSpec world = StraightWith({});
  world.tracks.push_back({.name = "wide", .offsets_m = {{0.0, 4.0}, {300.0, 4.0}, {400.0, 6.5}}});
  const TrackCourse wide = CourseOf(world, 1);
  EXPECT_EQ(wide.OffsetAt(300.0).d_m, 4.0);
  EXPECT_NEAR(wide.OffsetAt(350.0).d_m, 5.25, kExact_m);
  EXPECT_NEAR(wide.OffsetAt(350.0).slope, 2.5 / 100.0 * 30.0 / 16.0, 1e-12);
  EXPECT_EQ(wide.OffsetAt(400.0).d_m, 6.5);
  EXPECT_EQ(wide.OffsetAt(900.0).d_m, 6.5);
  for (const double s_m : {300.0, 400.0}) {
    EXPECT_NEAR(wide.OffsetAt(s_m).slope, 0.0, 1e-12);
    EXPECT_NEAR(wide.OffsetAt(s_m).bend_per_m, 0.0, 1e-12);
  }
}

TEST(Network, ContinuesATurnoutWithElements) {
  WorldSpec world = StraightWith({});
  TurnoutSpec turnout = On("main", 100.0, TurnoutType::k9_190);
  turnout.side = TrackSide::kLeft;
  world.tracks.push_back({.name = "lead",
                          .elements = {{ElementType::kStraight, 200.0, std::nullopt}},
                          .begin = turnout});
  const TrackCourse lead = CourseOf(world, 1);
  const double meet_s_m = 100.0 + GeometryOf(TurnoutType::k9_190).tangent_m;
  const double behind_m = 16.615 + 200.0;  // As far as the turnout's end, and the straight.
  EXPECT_NEAR(lead.end_s_m(), meet_s_m + behind_m * 9.0 / std::hypot(9.0, 1.0), 1e-3);
  EXPECT_NEAR(lead.OffsetAt(lead.end_s_m()).d_m, (lead.end_s_m() - meet_s_m) / 9.0, kExact_m);
}

TEST(Network, BendsATurnoutWithTheTrackInWhichItLies) {
  WorldSpec world = StraightWith({});
  world.tracks.push_back({.name = "curve",
                          .offset_m = 10.0,
                          .elements = {{ElementType::kArc, 200.0, 500.0}},
                          .start_s_m = 100.0});
  TurnoutSpec turnout = On("curve", 150.0);
  turnout.side = TrackSide::kRight;
  world.tracks.push_back({.name = "branch",
                          .elements = {{ElementType::kStraight, 50.0, std::nullopt}},
                          .begin = turnout});
  const Network network = MakeNetwork(world, 1000.0);
  EXPECT_NEAR(network.courses[2].OffsetAt(160.0).curvature_per_m(), 1.0 / 500.0 - 1.0 / 300.0,
              1e-9);
  EXPECT_NEAR(network.courses[2].OffsetAt(150.0).slope, network.courses[1].OffsetAt(150.0).slope,
              1e-12);
}

TEST(Network, ReportsTurnoutsThatLeadNowhere) {
  WorldSpec world = StraightWith({{.name = "a", .offset_m = 4.5, .begin = On("mian", 300.0)},
                                  {.name = "b", .offset_m = 9.0, .begin = On("b", 300.0)},
                                  {.name = "c", .offset_m = 13.5, .begin = On("d", 300.0)},
                                  {.name = "d", .offset_m = 18.0, .begin = On("c", 300.0)}});
  EXPECT_THAT(
      NetworkFaults(world),
      ElementsAre(
          "/world/tracks/1/begin/track: must be one of \"main\", \"a\", \"b\", \"c\", \"d\" "
          "(got \"mian\")",
          "/world/tracks/2/begin/track: must be another track (got \"b\")",
          "/world/tracks/4/begin/track: must not be a track that itself begins or ends on "
          "this one (got \"c\")"));
}

TEST(Network, ReportsGeometryThatDoesNotFit) {
  EXPECT_THAT(
      NetworkFaults(StraightWith({{.name = "a", .offset_m = 3.5, .begin = On("main", 300.0)}})),
      ElementsAre("/world/tracks/1/offset_m: must be 3.67 or more, where a turnout 1:9-300 "
                  "from track \"main\" and the curve behind it lead at least (got 3.5)"));
  EXPECT_THAT(
      NetworkFaults(StraightWith(
          {{.name = "a", .offset_m = -4.5, .begin = On("main", 300.0), .end = On("main", 400.0)}})),
      ElementsAre("/world/tracks/1/end/s_m: must be at least 447.462, for the track to "
                  "become parallel to the alignment before it (got 400)"));
  EXPECT_THAT(
      NetworkFaults(StraightWith({{.name = "a", .offset_m = 4.5, .begin = On("main", 980.0)}})),
      ElementsAre("/world/tracks/1/begin/s_m: must put the turnout on track \"main\", from 0 "
                  "to 1000 m (got from 980 to 1013.231 m)"));
  EXPECT_THAT(
      NetworkFaults(
          StraightWith({{.name = "second", .offset_m = 3.5},
                        {.name = "x",
                         .begin = On("main", 300.0),
                         .end = TurnoutSpec{"second", {}, TurnoutType::k9_300, {}, {}}}})),
      ElementsAre("/world/tracks/2: must join tracks that are at least 3.67 m apart, for both "
                  "turnouts to fit between them (got 3.5)"));
}

// A track at 42 degrees, and one that leaves it by the turnout's angle of atan(1/9) more.
TEST(Network, ReportsABranchThatLeavesTooSteeply) {
  EXPECT_THAT(
      NetworkFaults(StraightWith({{.name = "steep",
                                   .offset_m = 10.0,
                                   .elements = {{ElementType::kStraight, 200.0, std::nullopt}},
                                   .heading_deg = 42.0,
                                   .start_s_m = 100.0},
                                  {.name = "a", .offset_m = 300.0, .begin = On("steep", 120.0)}})),
      ElementsAre("/world/tracks/2: must run within 45 degrees of the alignment (got 48.34)"));
}

TEST(Network, BendsATurnoutWithATrackThatChangesItsCurvature) {
  WorldSpec world = StraightWith({});
  world.tracks.push_back({.name = "wide", .offsets_m = {{300.0, 10.0}, {400.0, 12.5}}});
  world.tracks.push_back({.name = "a", .offset_m = 20.0, .begin = On("wide", 350.0)});
  const Network network = MakeNetwork(world, 1000.0);
  const TrackCourse& wide = network.courses[1];
  const TrackCourse& branch = network.courses[2];
  EXPECT_NEAR(branch.OffsetAt(350.0).slope, wide.OffsetAt(350.0).slope, 1e-12);
  for (const double s_m : {350.1, 360.0, 370.0, 382.0}) {
    // The branch is up to 0.02 m longer than the track, and sampled every 0.5 m.
    EXPECT_NEAR(branch.OffsetAt(s_m).curvature_per_m(),
                wide.OffsetAt(s_m).curvature_per_m() + 1.0 / 300.0, 3e-6)
        << s_m;
  }
}

/// Where the course of a track jumps or has a kink, by samples every 0.05 m.
void ExpectSmooth(const TrackCourse& course) {
  for (double s_m = course.begin_s_m(); s_m + 0.05 < course.end_s_m(); s_m += 0.05) {
    const TrackOffset here = course.OffsetAt(s_m);
    const TrackOffset next = course.OffsetAt(s_m + 0.05);
    // Half the sharpest bend, 1 / 100 m, over 0.05 m squared.
    ASSERT_NEAR(next.d_m, here.d_m + 0.05 * here.slope, 1.3e-5) << s_m;
    ASSERT_NEAR(next.slope, here.slope, 6e-4) << s_m;
  }
}

TEST(Network, LeadsElementsToATurnoutAtTheirEnd) {
  TurnoutSpec end = On("main", 500.0, TurnoutType::k9_190);
  end.side = TrackSide::kLeft;
  const Network network =
      MakeNetwork(StraightWith({{.name = "a",
                                 .offset_m = 10.0,
                                 .elements = {{ElementType::kStraight, 200.0, std::nullopt}},
                                 .start_s_m = 100.0,
                                 .end = end}}),
                  1000.0);
  const TrackCourse& track = network.courses[1];
  EXPECT_EQ(track.OffsetAt(250.0).d_m, 10.0);
  EXPECT_EQ(track.end_s_m(), 500.0);
  EXPECT_NEAR(track.OffsetAt(500.0).d_m, 0.0, kExact_m);
  EXPECT_NEAR(track.OffsetAt(500.0).slope, 0.0, kExact_m);
  EXPECT_NEAR(track.OffsetAt(490.0).curvature_per_m(), 1.0 / 190.0, 1e-9);
  ASSERT_EQ(network.turnouts.size(), 1U);
  EXPECT_FALSE(network.turnouts[0].opens_ahead());
  ExpectSmooth(track);
}

TEST(Network, JoinsTracksThatAreNotParallelByTwoArcs) {
  const Network network = MakeNetwork(
      StraightWith({{.name = "second",
                     .offset_m = -4.0,
                     .elements = {{ElementType::kArc, 500.0, -9000.0}},
                     .heading_deg = 0.3,
                     .start_s_m = 200.0},
                    {.name = "x", .begin = On("main", 400.0), .end = On("second", 500.0)}}),
      1000.0);
  const TrackCourse& second = network.courses[1];
  const TrackCourse& crossover = network.courses[2];
  EXPECT_NEAR(crossover.OffsetAt(400.0).d_m, 0.0, kExact_m);
  EXPECT_NEAR(crossover.OffsetAt(500.0).d_m, second.OffsetAt(500.0).d_m, kExact_m);
  EXPECT_NEAR(crossover.OffsetAt(500.0).slope, second.OffsetAt(500.0).slope, kExact_m);
  EXPECT_EQ(network.turnouts[0].side, TrackSide::kRight);
  EXPECT_EQ(network.turnouts[1].side, TrackSide::kLeft);
  ExpectSmooth(crossover);
}

TEST(Network, ReportsAnEndTurnoutBehindItsElements) {
  TurnoutSpec end = On("main", 300.0, TurnoutType::k9_190);
  end.side = TrackSide::kLeft;
  EXPECT_THAT(
      NetworkFaults(StraightWith({{.name = "a",
                                   .offset_m = 10.0,
                                   .elements = {{ElementType::kStraight, 200.0, std::nullopt}},
                                   .start_s_m = 100.0,
                                   .end = end}})),
      ElementsAre("/world/tracks/1/end/s_m: must put the end of the turnout ahead of where "
                  "the track leads to it, at 300 m (got 272.963 m)"));
}

TEST(Network, ReportsTurnoutsThatOverlap) {
  const WorldSpec world =
      StraightWith({{.name = "a", .offset_m = 4.5, .begin = On("main", 300.0)},
                    {.name = "b", .offset_m = -4.5, .begin = On("main", 320.0)}});
  EXPECT_THAT(NetworkFaults(world),
              ElementsAre("/world/tracks/2/begin: must not overlap the turnout of track \"a\" on "
                          "track \"main\", from 300 to 333.231 m (got from 320 to 353.231 m)"));
}

TEST(Network, ReportsKeysThatContradictEachOther) {
  WorldSpec world = StraightWith(
      {{.name = "a", .offset_m = 4.5, .offsets_m = {{0.0, 4.5}}},
       {.name = "b", .offset_m = 9.0, .heading_deg = 3.0, .begin = On("main", 300.0)}});
  world.tracks[2].begin->s_m.reset();
  EXPECT_THAT(NetworkFaults(world),
              ElementsAre("/world/tracks/1/offsets_m: must not be given beside offset_m",
                          "/world/tracks/2/heading_deg: must be given for elements without a "
                          "turnout at their beginning only",
                          "/world/tracks/2/begin: must have s_m, the chainage of the turnout's "
                          "beginning"));
}

}  // namespace
}  // namespace railcast
