#include <gtest/gtest.h>

#include <set>
#include <string>

#include "tests/viewer/program/drawn_points.h"
#include "tests/viewer/program/recorded_run.h"
#include "tests/viewer/program/view_program.h"
#include "viewer/color/palette.h"

namespace railcast {
namespace {

class Compared : public Drawn {
 protected:
  static const RecordedRun& Fog() {
    static const RecordedRun run(YardScenario(R"({"visibility_m": 60})"), 2);
    return run;
  }
  const std::string clear_ = RecordedRun::Yard().path().string();
};

TEST_F(Compared, BesideEachOtherAreWhatTheyAreAlone) {
  const std::string fog = Fog().path().string();
  for (const std::string options :
       {"--frame 1", "--camera driver --color-by range --color-range 0,90",
        "--eye 30,12,6 --target 58,1,-1 --select wagon"}) {
    const Picture both = Draw(options + " " + clear_ + " --compare " + fog);
    const Picture left = Draw("--size 320x480 " + options + " " + clear_);
    const Picture right = Draw("--size 320x480 " + options + " " + fog);
    // Without the status in the lower left corner, whose long paths are cut off at different edges.
    EXPECT_TRUE(both.Part({0, 0}, 320, 440) == left.Part({0, 0}, 320, 440)) << options;
    EXPECT_TRUE(both.Part({320, 0}, 320, 440) == right.Part({0, 0}, 320, 440)) << options;
    EXPECT_GT(Differences(left, right).size(), 1000U);
  }
}

TEST_F(Compared, WithItselfHasOneColour) {
  const Picture picture = Draw("--layout distance " + clear_ + " --compare " + clear_);
  std::set<Rgb> colors;
  // Two sources have two statuses at the bottom; the title of the scale is above the points.
  for (int y = kHeight / 5; y < 0.85 * kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      if (IsClearOfWords({x, y}, picture)) colors.insert(picture.At(x, y));
    }
  }
  EXPECT_EQ(colors.size(), 2U);  // One colour of points, and the background's.
}

TEST_F(Compared, WithFogHasTheColoursOfWhatIsMissing) {
  const Picture picture = Draw("--camera driver --layout distance --color-range 0,1 " + clear_ +
                               " --compare " + Fog().path().string());
  // Points that the fog swallowed are far from all that are left; nearby points are in both clouds.
  EXPECT_GT(PointsOf(MapColor(ColorMap::kViridis, 1.0), picture).size(), 2000U);
  std::size_t num_near = 0;
  for (int step = 0; step <= 102; ++step) {
    num_near += PointsOf(MapColor(ColorMap::kViridis, step / 1023.0), picture).size();
  }
  EXPECT_GT(num_near, 2000U);
}

TEST_F(Compared, EndsWithTheShorterOne) {
  EXPECT_EQ(View("--screenshot " + PathOf("out.png") + " --frame 5 " + clear_ + " --compare " +
                 Fog().path().string())
                .status,
            1);
  const Ended video = View("--size 320x240 --video " + PathOf("video") + " " + clear_ +
                           " --compare " + Fog().path().string());
  EXPECT_EQ(video.status, 0) << video.said;
  EXPECT_TRUE(std::filesystem::exists(PathOf("video/000001.png")));
  EXPECT_FALSE(std::filesystem::exists(PathOf("video/000002.png")));
}

}  // namespace
}  // namespace railcast
