#include "viewer/plan/plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/rail/network/network.h"
#include "railcast/error.h"
#include "tests/core/io/message_of.h"
#include "tests/viewer/overlays/made_line.h"
#include "tests/viewer/plan/planned_yard.h"
#include "viewer/overlays/overlays.h"

namespace railcast {
namespace {

// Rounding of world coordinates below 1e6 m.
constexpr double kPlanRounding_m = 1e-8;

const Plan::Line* LineOf(const Plan& plan, const Rgb& rgb) {
  const auto found = std::ranges::find(plan.lines, rgb, &Plan::Line::rgb);
  return found == plan.lines.end() ? nullptr : &*found;
}

std::vector<std::string> TextsOf(const std::vector<Plan::Entry>& entries) {
  std::vector<std::string> texts;
  for (const Plan::Entry& entry : entries) texts.push_back(entry.text);
  return texts;
}

TEST(Plan, RunsFromLeftToRightWhereverTheLineLies) {
  AlignmentSpec line = Straight(30'000.0);
  line.origin_m = {700'000.0, 250'000.0, 400.0};
  line.heading_deg = 120.0;
  const ScenarioSpec scenario = ScenarioOnLine(line, 100.0);
  const Plan plan =
      MakePlan(scenario, *MakeWorld(scenario), {.from_s_m = 20'000.0, .to_s_m = 20'500.0});
  const Plan::Line* track = LineOf(plan, PlanTrackRgb(0));
  ASSERT_NE(track, nullptr);
  EXPECT_LT(track->points_m.front().norm(), kPlanRounding_m);
  EXPECT_LT((track->points_m.back() - Eigen::Vector2d(500.0, 0.0)).norm(), kPlanRounding_m);
  // North is 30 deg to the right of the line's direction.
  const double tolerance = 2.0 * kPlanRounding_m / 500.0;
  EXPECT_NEAR(plan.north.x(), std::sqrt(0.75), tolerance);
  EXPECT_NEAR(plan.north.y(), -0.5, tolerance);
}

TEST(Plan, FollowsTheCourseOfEveryTrack) {
  const PlannedYard yard;
  const PlanStretch stretch{.from_s_m = 100.0, .to_s_m = 300.0};
  const Plan plan = MakePlan(yard.scenario, *yard.world, stretch);
  for (std::size_t i = 0; i < yard.world->tracks().size(); ++i) {
    const TrackCourse& course = yard.world->network().courses[i];
    const PlanScene scene = ScenePlanned(yard.scenario, *yard.world, stretch);
    const auto points_m = PlanPoints(scene, course, {.from_s_m = 0.0, .to_s_m = 600.0}, 0.0);
    ASSERT_FALSE(points_m.empty()) << i;
    EXPECT_NEAR(points_m.front().x(), std::max(course.begin_s_m(), 100.0) - 100.0, kPlanRounding_m);
    EXPECT_NEAR(points_m.back().x(), std::min(course.end_s_m(), 300.0) - 100.0, kPlanRounding_m);
    for (const Eigen::Vector2d& point_m : points_m) {
      // The line is straight: the offset is the height on the sheet.
      EXPECT_NEAR(point_m.y(), course.OffsetAt(point_m.x() + 100.0).d_m, 1e-6) << i;
    }
  }
}

TEST(Plan, LeavesOutTracksBeyondTheStretch) {
  const PlannedYard yard;
  const Plan plan = MakePlan(yard.scenario, *yard.world, {.from_s_m = 0.0, .to_s_m = 100.0});
  EXPECT_THAT(TextsOf(plan.entries),
              testing::ElementsAre("route of the vehicle", "main", "second"));
  EXPECT_TRUE(plan.marks.empty());
}

TEST(Plan, MarksTurnoutsAsTheyAreSetWithTheirTipsAtTheBlades) {
  const PlannedYard yard;
  const Plan plan = MakePlan(yard.scenario, *yard.world, NetworkStretch(*yard.world));
  const auto& turnouts = yard.world->network().turnouts;
  const auto is_turnout = [](const Plan::Mark& mark) { return !mark.from_tip.isZero(); };
  EXPECT_EQ(std::ranges::count_if(plan.marks, is_turnout),
            static_cast<std::ptrdiff_t>(turnouts.size()));
  // The route leads from the main track through the yard's lead into its second track.
  EXPECT_EQ(std::ranges::count(plan.marks, kPlanDivergingRgb, &Plan::Mark::rgb), 2);
  const auto first = std::ranges::find_if(plan.marks, is_turnout);
  ASSERT_NE(first, plan.marks.end());
  EXPECT_LT((first->at_m - Eigen::Vector2d(kPlanMargin_m, 0.0)).norm(), kPlanRounding_m);
  EXPECT_GT(first->from_tip.x(), 0.99);
}

TEST(Plan, DrawsStructuresWhereTheyStand) {
  ScenarioSpec scenario = ScenarioOnLine(Straight(700.0), 100.0);
  NoiseWallSpec wall;
  wall.name = "wall";
  wall.begin_s_m = 50.0;
  wall.end_s_m = 650.0;
  wall.side = TrackSide::kRight;
  wall.distance_m = 4.5;
  RelayBoxSpec box;
  box.name = "box";
  box.s_m = 150.0;
  box.side = TrackSide::kLeft;
  scenario.world.structures = {wall, box};
  const Plan plan = MakePlan(scenario, *MakeWorld(scenario), {.from_s_m = 100.0, .to_s_m = 200.0});
  const auto entry = std::ranges::find(plan.entries, "noise wall", &Plan::Entry::text);
  ASSERT_NE(entry, plan.entries.end());
  const Plan::Line* line = LineOf(plan, entry->rgb);
  ASSERT_NE(line, nullptr);
  EXPECT_LT((line->points_m.front() - Eigen::Vector2d(0.0, -4.5)).norm(), kPlanRounding_m);
  EXPECT_LT((line->points_m.back() - Eigen::Vector2d(100.0, -4.5)).norm(), kPlanRounding_m);
  const auto relay_box = std::ranges::find(plan.entries, "relay box", &Plan::Entry::text);
  ASSERT_NE(relay_box, plan.entries.end());
  const auto mark = std::ranges::find(plan.marks, relay_box->rgb, &Plan::Mark::rgb);
  ASSERT_NE(mark, plan.marks.end());
  EXPECT_LT((mark->at_m - Eigen::Vector2d(50.0, 4.0)).norm(), kPlanRounding_m);
}

TEST(PlanStretch, ReachesFromBeforeTheFirstTurnoutToBehindTheLastTrack) {
  const PlannedYard yard;
  double last_s_m = 0.0;
  for (const TrackCourse& course : yard.world->network().courses) {
    if (course.end_s_m() < 600.0) last_s_m = std::max(last_s_m, course.end_s_m());
  }
  const PlanStretch stretch = NetworkStretch(*yard.world);
  EXPECT_EQ(stretch.from_s_m, 120.0 - kPlanMargin_m);
  EXPECT_EQ(stretch.to_s_m, last_s_m + kPlanMargin_m);
}

TEST(PlanStretch, ReachesFromWhereATrackWithoutTurnoutsBegins) {
  ScenarioSpec scenario = ScenarioOnLine(Straight(700.0), 100.0);
  scenario.world.tracks.push_back(
      {.name = "apart", .offset_m = 10.0, .start_s_m = 200.0, .end_s_m = 400.0});
  const PlanStretch stretch = NetworkStretch(*MakeWorld(scenario));
  EXPECT_EQ(stretch.from_s_m, 200.0 - kPlanMargin_m);
  EXPECT_EQ(stretch.to_s_m, 400.0 + kPlanMargin_m);
}

TEST(PlanStretch, IsTheWholeLineWithoutBranches) {
  const auto world = MakeWorld(ScenarioOnLine(Straight(700.0), 100.0));
  EXPECT_EQ(NetworkStretch(*world).from_s_m, 0.0);
  EXPECT_EQ(NetworkStretch(*world).to_s_m, 700.0);
}

TEST(PlanStretch, MustLieOnTheLine) {
  const auto world = MakeWorld(ScenarioOnLine(Straight(700.0), 100.0));
  const PlanStretch stretch = ChosenStretch(*world, {{20.0, 700.0}});
  EXPECT_EQ(stretch.from_s_m, 20.0);
  EXPECT_EQ(stretch.to_s_m, 700.0);
  EXPECT_EQ(MessageOf([&] {
              (void)ChosenStretch(*world, {{20.0, 700.5}});
            }),
            "--stretch: must be two chainages from 0 to 700, the lesser first (got 20 and "
            "700.5)");
  EXPECT_THROW((void)ChosenStretch(*world, {{-1.0, 700.0}}), InputError);
  EXPECT_THROW((void)ChosenStretch(*world, {{30.0, 30.0}}), InputError);
}

TEST(PlanStretch, HasTicksAtWholeSteps) {
  const PlanStretch stretch{.from_s_m = 90.0, .to_s_m = 300.0};
  EXPECT_THAT(WholeChainages_m(stretch.from_s_m, stretch.to_s_m, 100.0),
              testing::ElementsAre(100.0, 200.0, 300.0));
}

TEST(PlanStretch, RoundsStepsUp) {
  EXPECT_DOUBLE_EQ(RoundUp125(33.0), 50.0);
  EXPECT_DOUBLE_EQ(RoundUp125(50.1), 100.0);
  EXPECT_DOUBLE_EQ(RoundUp125(0.13), 0.2);
  EXPECT_DOUBLE_EQ(RoundUp125(1000.0), 1000.0);
}

}  // namespace
}  // namespace railcast
