#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "core/rail/motion/speed_profile.h"
#include "core/rail/motion/track_path.h"
#include "core/rail/network/junction_rails.h"
#include "core/rail/network/turnout_place.h"
#include "core/rail/track/cross_section.h"
#include "core/rail/track/track_structure.h"
#include "tests/core/rail/test_line.h"
#include "tests/core/rail/track/cut_rails.h"

namespace railcast {
namespace {

constexpr double kLoopBegins_m = 60.0;
constexpr double kCurve_m = 600.0;

TurnoutSpec MainTurnout(double s_m, TurnoutType type, TurnoutPosition position) {
  return {.track = "main", .s_m = s_m, .turnout = type, .side = {}, .position = position};
}

/// A curve to the left of 500 m with 100 mm of cant, and a loop on either side of its track.
WorldSpec CantedLoop(TurnoutType type, double offset_m, TurnoutPosition position) {
  WorldSpec spec = CantedArc(kCurve_m, 500.0);
  spec.alignment.cants_mm = {{0.0, 100.0}, {300.0, 100.0}};
  spec.tracks.push_back({.name = "loop",
                         .offset_m = offset_m,
                         .begin = MainTurnout(kLoopBegins_m, type, position),
                         .end = MainTurnout(kCurve_m - kLoopBegins_m, type, position)});
  return spec;
}

/// As above, with a second track beside the first one and a crossover to it.
WorldSpec CantedCrossover(TurnoutType type, double offset_m) {
  WorldSpec spec = CantedLoop(type, offset_m, TurnoutPosition::kStraight);
  spec.tracks[1] = TrackSpec{};
  spec.tracks[1].name = "second";
  spec.tracks[1].offset_m = offset_m;
  TrackSpec crossover{.name = "crossover",
                      .begin = MainTurnout(kLoopBegins_m, type, TurnoutPosition::kStraight)};
  crossover.end =
      TurnoutSpec{.track = "second", .s_m = {}, .turnout = type, .side = {}, .position = {}};
  spec.tracks.push_back(crossover);
  return spec;
}

/// A track that leaves the loop to its outer side where its height returns to that of the line.
WorldSpec CantedLadder(TurnoutType type, double side) {
  WorldSpec spec = CantedLoop(type, 4.5 * side, TurnoutPosition::kStraight);
  const TurnoutGeometry geometry = GeometryOf(type);
  const double parallel_m = 2.0 * geometry.tangent_m + 4.5 / std::tan(geometry.angle_rad);
  TrackSpec siding{
      .name = "siding",
      .offset_m = 9.0 * side,
      .begin = MainTurnout(kLoopBegins_m + parallel_m + 1.0, type, TurnoutPosition::kStraight)};
  siding.begin->track = "loop";
  siding.end_s_m = 400.0;
  spec.tracks.push_back(siding);
  return spec;
}

/// A lead that runs on at the turnout's angle, and a track that leaves it back to the line.
WorldSpec CantedLead(TurnoutType type, double side) {
  WorldSpec spec = CantedLoop(type, 0.0, TurnoutPosition::kStraight);
  TrackSpec& lead = spec.tracks[1];
  lead = TrackSpec{};
  lead.name = "lead";
  lead.begin = MainTurnout(kLoopBegins_m, type, TurnoutPosition::kStraight);
  lead.begin->side = side > 0.0 ? TrackSide::kLeft : TrackSide::kRight;
  lead.elements = {{ElementType::kStraight, 150.0, std::nullopt}};
  TrackSpec first = lead;
  first.name = "first";
  first.begin->track = "lead";
  first.begin->s_m = kLoopBegins_m + GeometryOf(type).length_m + 20.0;
  first.begin->side = side > 0.0 ? TrackSide::kRight : TrackSide::kLeft;
  first.elements = {{ElementType::kStraight, 20.0, std::nullopt}};
  spec.tracks.push_back(first);
  return spec;
}

/// The heights at which the gauge lines of both inner rails pass the frog differ by that.
double StepInFrog_m(const TestLine& line, const TurnoutSite& site) {
  const TrackCourse& through = line.network().courses[site.track];
  const TrackCourse& branch = line.network().courses[site.branch];
  const FrogPoint frog = FrogOf({site, through, branch});
  const double side = SignOf(site.side);
  const Vector3 on_through = through.WorldFromTrack(line.alignment(), frog.through_s_m) *
                             Vector3(0.0, side * kHalf_m, 0.0);
  const Vector3 on_branch =
      branch.WorldFromTrack(line.alignment(), frog.branch_s_m) * Vector3(0.0, -side * kHalf_m, 0.0);
  return on_branch.z() - on_through.z();
}

TEST(CantedTurnout, HasBothRailsOfItsFrogAtOneHeight) {
  for (const TurnoutType type : kTurnoutTypes) {
    for (const double side : {-1.0, 1.0}) {
      for (const WorldSpec& spec :
           {CantedLoop(type, 4.5 * side, TurnoutPosition::kStraight),
            CantedCrossover(type, 4.5 * side), CantedLadder(type, side), CantedLead(type, side)}) {
        const TestLine line(spec);
        ASSERT_GE(line.network().turnouts.size(), 2U);
        for (const TurnoutSite& site : line.network().turnouts) {
          EXPECT_NEAR(StepInFrog_m(line, site), 0.0, 1e-3)
              << NameOf(type) << " to track " << spec.tracks[site.branch].name << ", " << side;
        }
      }
    }
  }
}

TEST(CantedTurnout, LeavesAWayForFlangesOnTheRouteThatItIsSetFor) {
  for (const TurnoutType type : kTurnoutTypes) {
    for (const double offset_m : {-4.5, 4.5}) {
      const std::string what(NameOf(type));
      ExpectFlangesFindAWay(TestLine(CantedLoop(type, offset_m, TurnoutPosition::kStraight)),
                            {0, 50.5, 119.5}, what + " straight");
      ExpectFlangesFindAWay(TestLine(CantedLoop(type, offset_m, TurnoutPosition::kDiverging)),
                            {1, 60.5, 119.5}, what + " diverging");
    }
  }
}

TEST(CantedTurnout, HasNothingAboveItsRailsButCheckRails) {
  constexpr double kAboveCheckRails_m = 0.022;
  for (const double offset_m : {-4.5, 4.5}) {
    const TestLine line(CantedLoop(TurnoutType::k9_190, offset_m, TurnoutPosition::kStraight));
    const BuiltTracks tracks(line);
    for (const std::size_t track : {0U, 1U}) {
      for (double s_m = 61.0; s_m < 94.0; s_m += 1.1) {
        EXPECT_TRUE(CutRails(tracks, track, s_m).At(kAboveCheckRails_m).empty())
            << track << " at " << s_m;
      }
    }
  }
}

TEST(CantedTurnout, RestsOnBearersInThePlaneOfItsRails) {
  for (const double offset_m : {-4.5, 4.5}) {
    const TestLine line(CantedLoop(TurnoutType::k9_300, offset_m, TurnoutPosition::kStraight));
    const TrackCourse& through = line.network().courses[0];
    int num_parts = 0;
    const BuiltTracks tracks(line);
    for (const Placement& placement : tracks.At(80.0).placements) {
      if (placement.model == line.models().concrete_sleeper) continue;
      const Transform world_from_model =
          line.WorldFromChunk(1) * Transform(placement.chunk_from_model.matrix());
      Vector3 nearest(std::numeric_limits<double>::infinity(), 0.0, 0.0);
      for (double s_m = 50.0; s_m < 100.5; s_m += 0.1) {
        const Vector3 place = through.WorldFromTrack(line.alignment(), s_m).inverse() *
                              world_from_model.translation();
        if (std::abs(place.x()) < std::abs(nearest.x())) nearest = place;
      }
      EXPECT_NEAR(nearest.z(), 0.0, 2e-3) << placement.model->name;
      ++num_parts;
    }
    EXPECT_GT(num_parts, 100);
  }
}

TEST(CantedTurnout, HasBallastBelowTheSleepersOfBothTracks) {
  const TestLine line(CantedLoop(TurnoutType::k9_300, -4.5, TurnoutPosition::kStraight));
  for (double s_m = 60.3; s_m < 240.0; s_m += 3.0) {
    const ChunkContext context = line.Context(static_cast<int>(s_m / TestLine::kChunkLength_m));
    const CrossSection section(context, s_m);
    for (const TrackCourse& track : context.tracks) {
      const double d_m = track.OffsetAt(s_m).d_m;
      const Vector3 top_m = section.PointAt(d_m, section.BallastHeight_m(d_m));
      const Transform track_from_chunk =
          (context.chunk_from_world * track.WorldFromTrack(line.alignment(), s_m)).inverse();
      // The lower middle of a concrete sleeper, less 20 mm, and where the sleepers of the other
      // track lie, less 20 mm only.
      EXPECT_LT((track_from_chunk * top_m).z(), -0.182 - 0.018) << s_m;
      EXPECT_GT((track_from_chunk * top_m).z(), -0.221 - 0.042) << s_m;
    }
  }
}

TEST(CantedTurnout, LeavesTheFormationToTheLineBehindTheEndOfItsBranch) {
  WorldSpec spec = CantedLoop(TurnoutType::k9_300, -4.5, TurnoutPosition::kStraight);
  spec.tracks[1].end.reset();
  spec.tracks[1].end_s_m = 135.0;
  const TestLine line(spec);
  EXPECT_GT(line.network().courses[1].LiftAt(line.alignment(), 135.0).h_m, 0.1);
  const auto formation_m = [&](double s_m) {
    const int chunk = static_cast<int>(s_m / TestLine::kChunkLength_m);
    return CrossSection(line.Context(chunk), s_m).FormationHeight_m(-6.0);
  };
  EXPECT_GT(formation_m(134.9), 0.1 - CrossSection::kFormationDepth_m);
  EXPECT_NEAR(formation_m(135.1), formation_m(134.9), 5e-3);
  EXPECT_NEAR(formation_m(165.1), -CrossSection::kFormationDepth_m, 1e-9);
}

/// The largest change of a track's gradient, every `step_m`, against the chainage.
double SharpestBend_per_m(const TestLine& line, std::size_t track, double step_m) {
  const TrackCourse& course = line.network().courses[track];
  const auto height_m = [&](double s_m) {
    return course.WorldFromTrack(line.alignment(), s_m).translation().z();
  };
  double sharpest_per_m = 0.0;
  for (double s_m = course.begin_s_m(); s_m < course.end_s_m(); s_m += step_m) {
    const double bend =
        (height_m(s_m - step_m) - 2.0 * height_m(s_m) + height_m(s_m + step_m)) / (step_m * step_m);
    sharpest_per_m = std::max(sharpest_per_m, std::abs(bend));
  }
  return sharpest_per_m;
}

TEST(CantedTurnout, LetsItsBranchReturnWithoutStepOrKink) {
  // A kink by 1 permil would have a radius of 50 m at this step.
  constexpr double kFineStep_m = 0.05;
  for (const TurnoutType type : kTurnoutTypes) {
    for (const double side : {-1.0, 1.0}) {
      const TestLine loop(CantedLoop(type, 4.5 * side, TurnoutPosition::kStraight));
      EXPECT_LT(SharpestBend_per_m(loop, 1, kFineStep_m), 1.0 / 1000.0) << NameOf(type);
      const TestLine crossover(CantedCrossover(type, 4.5 * side));
      EXPECT_LT(SharpestBend_per_m(crossover, 2, kFineStep_m), 1.0 / 50.0) << NameOf(type);
    }
  }
}

/// The steepest gradient of a track against the line, and that it is the derivative of its height.
double SteepestLift(const TestLine& line, std::size_t track) {
  const TrackCourse& course = line.network().courses[track];
  constexpr double kHalfStep_m = 1e-3;
  double steepest = 0.0;
  for (double s_m = course.begin_s_m(); s_m < course.end_s_m(); s_m += 0.25) {
    const TrackLift lift = course.LiftAt(line.alignment(), s_m);
    const double rise_m = course.LiftAt(line.alignment(), s_m + kHalfStep_m).h_m -
                          course.LiftAt(line.alignment(), s_m - kHalfStep_m).h_m;
    // The bend of at most 0.02 per m may begin or end there.
    EXPECT_NEAR(lift.slope, rise_m / (2.0 * kHalfStep_m), 0.02 * kHalfStep_m) << s_m;
    steepest = std::max(steepest, std::abs(lift.slope));
  }
  return steepest;
}

TEST(CantedTurnout, LetsItsBranchReturnToTheHeightOfTheLine) {
  for (const TurnoutType type : kTurnoutTypes) {
    for (const double side : {-1.0, 1.0}) {
      const TestLine loop(CantedLoop(type, 4.5 * side, TurnoutPosition::kStraight));
      EXPECT_EQ(loop.network().courses[1].LiftAt(loop.alignment(), 0.5 * kCurve_m).h_m, 0.0);
      EXPECT_LT(SteepestLift(loop, 1), 0.010) << NameOf(type);
      const TestLine crossover(CantedCrossover(type, 4.5 * side));
      EXPECT_LT(SteepestLift(crossover, 2), 0.052) << NameOf(type);
    }
  }
}

TEST(CantedTurnout, LeadsAVehicleOverItWithoutAJump) {
  const TestLine line(CantedLoop(TurnoutType::k9_190, -4.5, TurnoutPosition::kDiverging));
  const TrackCourse& main = line.network().courses[0];
  const TrackCourse& loop = line.network().courses[1];
  const TrackCourse course =
      Joined(Joined(main, loop, kLoopBegins_m), main, kCurve_m - kLoopBegins_m);
  TrackPose pose{.pivot_distance_m = 10.4};
  const TrackPath path(course, pose, SpeedProfile({}, 0.0));
  constexpr double kFineStep_m = 0.02;
  Transform before = path.WorldFromObjectAt(line.alignment(), 20.0);
  for (double s_m = 20.0 + kFineStep_m; s_m < kCurve_m - 20.0; s_m += kFineStep_m) {
    const Transform here = path.WorldFromObjectAt(line.alignment(), s_m);
    // At most as steep as the test above says. The arc back has a radius of 138 m.
    EXPECT_LT(std::abs(here.translation().z() - before.translation().z()), 0.010 * kFineStep_m)
        << s_m;
    EXPECT_LT(Eigen::AngleAxisd(before.linear().transpose() * here.linear()).angle(),
              kFineStep_m / 100.0)
        << s_m;
    before = here;
  }
}

}  // namespace
}  // namespace railcast
