#include "generator/extras/insert/plan/plan_check.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/core/io/temporary_directory.h"
#include "tests/generator/extras/insert/plan/plan_project.h"

namespace railcast {
namespace {

/// A plan of a box 1 m wide and high, 20 m ahead of a VLP-16 that stands 1 m above the rails, and a
/// second one behind the first.
struct CheckedPlan {
  explicit CheckedPlan(const std::vector<std::string>& points) {
    const auto source = WriteReceived(folder.path() / "run", StraightRun(4, 0.0), points);
    const std::string box = R"("type": "box", "size_m": [1, 1, 1], "d_m": 0, "h_m": 2, )";
    const auto file = WritePlan(folder.path(), "{}",
                                R"(, "objects": [{"name": "near", )" + box +
                                    R"("s_m": 20.5}, {"name": "far", )" + box + R"("s_m": 900}])",
                                VelodyneOfPlan());
    plan = ReadInsertPlan(file, source);
    check = CheckPlan(plan, source, {0, static_cast<std::uint32_t>(plan.frame_times_ns.size())});
  }

  TemporaryDirectory folder;
  InsertPlan plan;
  PlanCheck check;
};

TEST(PlanCheck, CountsTheFiringsThatAimAtAThing) {
  const CheckedPlan checked({"5 5 0"});
  ASSERT_EQ(checked.check.things.size(), 2U);
  const ThingCheck& near = checked.check.things[0];
  EXPECT_EQ(near.num_frames_in_reach, 4U);
  // The face is 1 m wide at 20 m, from 0.5 m below the sensor to 0.5 m above it: the rows at -1 and
  // 1 deg in 2.864 deg of azimuth, of which there are 1808 steps.
  EXPECT_NEAR(static_cast<double>(near.most_firings), 2.0 * 2.864 / 360.0 * 1808.0, 4.0);
  EXPECT_EQ(near.num_points, 0U);
  EXPECT_EQ(checked.check.things[1].num_frames_in_reach, 0U);
}

TEST(PlanCheck, SaysWhatWasRecordedWhereAThingShallBe) {
  // Two points before the box, one inside it, one behind it, one in the ground below its foot.
  const CheckedPlan checked({"10 0 0", "19 0 0.1", "20.3 0.1 0", "40 0 0", "20.5 0 -0.45"});
  const ThingCheck& near = checked.check.things[0];
  EXPECT_EQ(near.num_points, 4U * 5U);
  EXPECT_EQ(near.num_points_before, 4U * 2U);
  EXPECT_EQ(near.num_points_inside, 4U * 1U);
  EXPECT_EQ(near.num_frames_inside, 4U);
  const std::string text = PlanCheckText(checked.plan, checked.check);
  EXPECT_EQ(text.substr(0, text.find("  aimed")),
            "near:\n  at chainage 20.5 m, 0 m left, 2 m above the rails (asked: s_m 20.5, d_m 0, "
            "h_m 2)\n");
  EXPECT_NE(
      text.find("; of 20 recorded points in its direction 40 % are before it, 20 % inside it, "
                "in 4 of 4 frames: a recorded surface stands there\n"),
      text.npos)
      << text;
  EXPECT_NE(text.find("\n  no firing aims at it in any of the 4 frames\n"), text.npos) << text;
}

}  // namespace
}  // namespace railcast
