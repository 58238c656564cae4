#include <gtest/gtest.h>

#include <string>

#include "tests/viewer/program/squares.h"

namespace railcast {
namespace {

constexpr Rgb kRed = {255, 0, 0};
constexpr Rgb kGreen = {0, 255, 0};
constexpr Rgb kBackground = {26, 26, 28};

using Screenshot = Squares;

TEST_F(Screenshot, ShowsBlocksInTheirLabelsColoursWhereTheyAre) {
  WriteSquares("cloud.pcd");
  WriteLabels("labels.json");
  DrawSquares(PathOf("cloud.pcd"));
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
  DrawSquares("--color-by height " + PathOf("cloud.pcd"));
  // The block is 36 px high. A point covers 1 px on all sides of its own pixel, which is up to half
  // a pixel off, and so is the prediction: 2 px of 36.
  for (const double z_m : {-0.9, -0.5, 0.0, 0.5, 0.9}) {
    EXPECT_NEAR(PlaceOnScale(At(0.0, PixelsAbove(z_m))), 0.5 + 0.5 * z_m, 2.0 / 36.0) << z_m;
  }
}

TEST_F(Screenshot, LooksAtACloudInWorldCoordinatesFromItsMiddle) {
  WriteSquares("cloud.pcd", 5000);  // Its middle is at (4960, 2.5, 0).
  WriteLabels("labels.json");
  DrawSquares(PathOf("cloud.pcd"));
  EXPECT_EQ(At(2.5 * MetreInPixels(), PixelsAbove(0.0)), kRed);
  EXPECT_EQ(At(-2.5 * MetreInPixels(), PixelsAbove(0.0)), kGreen);
  EXPECT_EQ(At(0.0, PixelsAbove(0.0)), kBackground);
}

TEST_F(Screenshot, SaysWhereItCannotWrite) {
  WriteSquares("cloud.pcd");
  const Ended ended = View("--screenshot /no/such/out.png " + PathOf("cloud.pcd"));
  EXPECT_EQ(ended.status, 1);
  EXPECT_EQ(ended.said, "error: /no/such/out.png: no such file or directory\n");
}

TEST_F(Screenshot, SaysHowToRunWithoutADisplayWhereNothingElseIsWrong) {
  WriteSquares("cloud.pcd");
  const std::string cloud = PathOf("cloud.pcd");
  const auto said = [&](const std::string& arguments) {
    const Ended ended = RunCommand("env -u DISPLAY " RAILCAST_VIEW " " + arguments);
    EXPECT_EQ(ended.status, 1) << arguments;
    return ended.said;
  };
  EXPECT_EQ(said(cloud),
            "error: no display: on a machine without one, run xvfb-run -a -s -noreset "
            "railcast-view ...\n");
  EXPECT_EQ(said("gone.pcd"), "error: gone.pcd: no such file or directory\n");
  EXPECT_EQ(said("--select rail " + cloud),
            "error: --select: must be labels of the recording (got rail)\n");
}

}  // namespace
}  // namespace railcast
