#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "tests/viewer/view_program.h"

namespace railcast {
namespace {

constexpr Rgb kRed = {255, 0, 0};
constexpr Rgb kGreen = {0, 255, 0};
constexpr Rgb kBackground = {26, 26, 28};

TEST_F(Screenshot, ShowsBlocksInTheirLabelsColoursWhereTheyAre) {
  WriteSquares("cloud.pcd");
  WriteLabels("labels.json");
  Draw(PathOf("cloud.pcd"));
  for (const double dz : {-0.9, 0.0, 0.9}) {
    for (const double dy : {-0.9, 0.0, 0.9}) {
      EXPECT_EQ(At(dy * MetreInPixels(), PixelsAbove(dz)), kRed) << dy << ' ' << dz;
      EXPECT_EQ(At((dy - 5.0) * MetreInPixels(), PixelsAbove(dz)), kGreen) << dy << ' ' << dz;
    }
  }
  for (const double outside : {-1.3, 1.3}) {
    EXPECT_EQ(At(0.0, PixelsAbove(outside)), kBackground);
    EXPECT_EQ(At(outside * MetreInPixels(), PixelsAbove(0.0)), kBackground);
    EXPECT_EQ(At((outside - 5.0) * MetreInPixels(), PixelsAbove(0.0)), kBackground);
  }
  EXPECT_EQ(At(5.0 * MetreInPixels(), PixelsAbove(0.0)), kBackground);
}

TEST_F(Screenshot, ShowsHeightOnTheScale) {
  WriteSquares("cloud.pcd");
  Draw("--color-by height " + PathOf("cloud.pcd"));
  // The block is 36 px high. A point covers 1 px to all sides of its own pixel, which is up to half
  // a pixel off, and so is ours: 2 px of 36.
  for (const double z_m : {-0.9, -0.5, 0.0, 0.5, 0.9}) {
    EXPECT_NEAR(PlaceOnScale(At(0.0, PixelsAbove(z_m))), 0.5 + 0.5 * z_m, 2.0 / 36.0) << z_m;
  }
}

TEST_F(Screenshot, ShowsTheChosenFrameOfASequenceWithItsLabels) {
  Write("run/frames/000000.pcd", "not read");
  WriteSquares("run/frames/000007.pcd");
  WriteLabels("run/labels.json");
  Draw("--frame 7 " + PathOf("run"));
  EXPECT_EQ(At(0.0, PixelsAbove(0.0)), kRed);
}

TEST_F(Screenshot, LooksAtACloudInWorldCoordinatesFromItsMiddle) {
  WriteSquares("cloud.pcd", 5000);  // The middle is at (4960, 2.5, 0).
  WriteLabels("labels.json");
  Draw(PathOf("cloud.pcd"));
  EXPECT_EQ(At(2.5 * MetreInPixels(), PixelsAbove(0.0)), kRed);
  EXPECT_EQ(At(-2.5 * MetreInPixels(), PixelsAbove(0.0)), kGreen);
  EXPECT_EQ(At(0.0, PixelsAbove(0.0)), kBackground);
}

TEST_F(Screenshot, SaysWhereItCannotWrite) {
  WriteSquares("cloud.pcd");
  const Result result =
      Execute(kOnADisplay + (" --screenshot /no/such/out.png " + PathOf("cloud.pcd")));
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.output, "error: /no/such/out.png: no such file or directory\n");
}

TEST_F(RailcastView, SaysHowToRunWithoutADisplay) {
  WriteSquares("cloud.pcd");
  const Result result = Execute("env -u DISPLAY " RAILCAST_VIEW " " + PathOf("cloud.pcd"));
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.output,
            "error: no display: on a machine without one, run xvfb-run -a -s -noreset "
            "railcast-view ...\n");
}

TEST_F(RailcastView, NamesFilesThatCannotBeShown) {
  Write("notes.txt", "hello\n");
  Write("garbage.pcd", "this is no cloud\n");
  Write("empty/readme", "");
  Write("run/frames/000000.pcd", "");
  Write("run/frames/000002.pcd", "");
  Write("short/frames/000005.pcd", "");
  const std::pair<std::string, std::string> cases[] = {
      {PathOf("gone.pcd"), PathOf("gone.pcd") + ": no such file or directory"},
      {PathOf("garbage.pcd"),
       PathOf("garbage.pcd") + ": is no PCD file: a header line begins with none of its keys"},
      {PathOf("notes.txt"), PathOf("notes.txt") + ": must be a .pcd or .ply file"},
      {PathOf("empty"), PathOf("empty") + ": is no sequence directory (it has no frames/)"},
      {PathOf("run") + " --frame 3",
       PathOf("run/frames") + ": has no frame 000003 (it has 2 frames, 000000 to 000002)"},
      {PathOf("short") + " --frame 3",
       PathOf("short/frames") + ": has no frame 000003 (it has 000005)"}};
  for (const auto& [arguments, fault] : cases) {
    const Result result = Execute(RAILCAST_VIEW " " + arguments);
    EXPECT_EQ(result.exit_code, 1) << arguments;
    EXPECT_EQ(result.output, "error: " + fault + "\n");
  }
}

TEST_F(RailcastView, NamesFieldsThatAreMissing) {
  WriteSquares("cloud.pcd");
  const Result result = Execute(RAILCAST_VIEW " --color-by intensity " + PathOf("cloud.pcd"));
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.output,
            "error: " + PathOf("cloud.pcd") + ": has no field intensity to color by\n");
}

TEST_F(RailcastView, EndsWithTwoAfterAWrongCommandLine) {
  WriteSquares("cloud.pcd");
  for (const char* const arguments : {"", "--color-by taste ", "--camera moon ", "--size 10x10 ",
                                      "--size wide ", "--frame 1 ", "--frame -1 "}) {
    const std::string source = *arguments == '\0' ? "" : PathOf("cloud.pcd");
    EXPECT_EQ(Execute(RAILCAST_VIEW " " + (arguments + source)).exit_code, 2) << arguments;
  }
  EXPECT_EQ(Execute(RAILCAST_VIEW " --frame 1 udp://127.0.0.1").exit_code, 2);
  EXPECT_EQ(Execute(RAILCAST_VIEW " --help").exit_code, 0);
  EXPECT_EQ(Execute(RAILCAST_VIEW " --version").exit_code, 0);
}

}  // namespace
}  // namespace railcast
