#include "viewer/plan/plan_stretch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "core/rail/network/network.h"
#include "railcast/error.h"
#include "tests/viewer/overlays/made_line.h"
#include "tests/viewer/plan/planned_yard.h"

namespace railcast {
namespace {

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
  try {
    (void)ChosenStretch(*world, {{20.0, 700.5}});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "--stretch: must be two chainages from 0 to 700, the lesser first (got 20 and "
                 "700.5)");
  }
  EXPECT_THROW((void)ChosenStretch(*world, {{-1.0, 700.0}}), InputError);
  EXPECT_THROW((void)ChosenStretch(*world, {{30.0, 30.0}}), InputError);
}

TEST(PlanStretch, HasTicksAtWholeSteps) {
  const PlanStretch stretch{.from_s_m = 90.0, .to_s_m = 300.0};
  EXPECT_THAT(stretch.WholeChainages_m(100.0), testing::ElementsAre(100.0, 200.0, 300.0));
}

TEST(PlanStretch, RoundsStepsUp) {
  EXPECT_DOUBLE_EQ(RoundUp125(33.0), 50.0);
  EXPECT_DOUBLE_EQ(RoundUp125(50.1), 100.0);
  EXPECT_DOUBLE_EQ(RoundUp125(0.13), 0.2);
  EXPECT_DOUBLE_EQ(RoundUp125(1000.0), 1000.0);
}

}  // namespace
}  // namespace railcast
