#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "tests/viewer/program/view_program.h"
#include "viewer/plan/plan.h"

namespace railcast {
namespace {

class PlanPicture : public Drawn {
 protected:
  const std::string yard_ = RAILCAST_SOURCE_DIR "/scenarios/yard.json";
};

TEST_F(PlanPicture, DrawsEachTrackInItsColour) {
  const Picture picture = Draw(yard_);
  ASSERT_EQ(picture.width, kWidth);
  ASSERT_EQ(picture.height, kHeight);
  const auto main = picture.PlacesOf(PlanTrackRgb(0));
  const auto [left, right] = std::ranges::minmax(main, {}, &Pixel::x);
  EXPECT_GT(right.x - left.x, kWidth / 2);
  // The second track is 4 m to the left; the yard lies to the right.
  const auto top = [&](std::size_t track) {
    return std::ranges::min(picture.PlacesOf(PlanTrackRgb(track)), {}, &Pixel::y).y;
  };
  EXPECT_LT(top(1), top(0));
  EXPECT_GT(top(4), top(0));
  EXPECT_GT(picture.Count(kPlanDivergingRgb), 0U);
  EXPECT_EQ(Draw(yard_), picture);
}

TEST_F(PlanPicture, ShowsAStretch) {
  const Picture picture = Draw("--stretch 0 100 " + yard_);
  EXPECT_GT(picture.Count(PlanTrackRgb(1)), 0U);
  EXPECT_EQ(picture.Count(PlanTrackRgb(2)), 0U);
  EXPECT_EQ(picture.Count(kPlanDivergingRgb), 0U);
}

TEST_F(PlanPicture, SaysWhatIsWrong) {
  const auto said = [&](const std::string& arguments) { return View(arguments).said; };
  const std::string to = "--screenshot " + PathOf("out.png") + " ";
  EXPECT_EQ(said(to + "--stretch 10 700 " + yard_),
            "error: --stretch: must be two chainages from 0 to 600, the lesser first (got 10 and "
            "700)\n");
  const std::string help = "\nRun with --help for more information.\n";
  EXPECT_EQ(said(to + "--stretch 20 10 " + yard_),
            "--stretch: must be two chainages, the lesser first (got 20 and 10)" + help);
  EXPECT_EQ(said(yard_), "--screenshot: is needed for the plan of a scenario" + help);
  EXPECT_EQ(said(to + "--frame 3 " + yard_), "--frame: is not for the plan of a scenario" + help);
  EXPECT_EQ(said(to + "--stretch 0 10 cloud.pcd"),
            "--stretch: is for the plan of a scenario" + help);
  EXPECT_EQ(said(to + PathOf("gone.json")), "error: " + PathOf("gone.json") + ": no such file\n");
  Write("labels.json", R"({"labels": []})");
  EXPECT_THAT(said(to + PathOf("labels.json")),
              testing::StartsWith("error: " + PathOf("labels.json") + ": "));
  EXPECT_FALSE(std::filesystem::exists(PathOf("out.png")));
}

}  // namespace
}  // namespace railcast
