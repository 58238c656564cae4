#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "tests/viewer/program/recorded_run.h"
#include "tests/viewer/program/window_program.h"
#include "viewer/frames/camera_picture.h"

namespace railcast {
namespace {

// In a window of 640 x 480, an image of 40 x 25 pixels is 256 pixels wide, two fifths, and leaves a
// margin of 8.
constexpr int kImageWidth = 40;
constexpr int kImageHeight = 25;
constexpr int kInsetWidth = 256;
constexpr int kInsetHeight = 160;
constexpr Pixel kInsetAt{640 - 8 - kInsetWidth, 8};

std::string YardWithCamera() {
  std::string scenario = YardScenario();
  const std::string lidar = "\"lidar\":";
  return scenario.insert(scenario.find(lidar),
                         R"("camera": {"name": "front", "width_px": 40, "height_px": 25,
                            "horizontal_fov_deg": 60},
    )");
}

/// Two frames with images.
const RecordedRun& FilmedYard() {
  static const RecordedRun run(YardWithCamera(), 2);
  return run;
}

class CameraImageInset : public WindowTest {
 protected:
  /// Expects the image of a frame in the upper right corner.
  static void ExpectImage(const Picture& picture, std::size_t frame, PictureKind kind) {
    const auto image = RecordedPictures(FilmedYard().path()).At(frame, kind);
    ASSERT_TRUE(image);
    Picture expected{kInsetWidth, kInsetHeight, {}};
    for (int y = 0; y < kInsetHeight; ++y) {
      for (int x = 0; x < kInsetWidth; ++x) {
        const auto row = static_cast<std::size_t>(y * kImageHeight / kInsetHeight);
        const auto column = static_cast<std::size_t>(x * kImageWidth / kInsetWidth);
        expected.pixels.push_back(image->pixels.at(row * kImageWidth + column));
      }
    }
    EXPECT_TRUE(picture.Part(kInsetAt, kInsetWidth, kInsetHeight) == expected);
  }

  const std::string path_ = FilmedYard().path().string();
};

TEST_F(CameraImageInset, IsThatOfTheFrame) {
  const Picture off = Draw("--image off " + path_);
  const Picture color = Draw(path_);
  ExpectImage(color, 0, PictureKind::kColor);
  ExpectImage(Draw("--frame 1 " + path_), 1, PictureKind::kColor);
  ExpectImage(Draw("--image label " + path_), 0, PictureKind::kLabel);
  ExpectImage(Draw("--image depth " + path_), 0, PictureKind::kDepth);
  // Beside the image and its title, nothing is changed.
  for (const Pixel& pixel : Differences(off, color)) {
    EXPECT_GE(pixel.x, kInsetAt.x);
    EXPECT_LT(pixel.y, kInsetAt.y + kInsetHeight + 0.04 * kHeight);
  }
}

TEST_F(CameraImageInset, LeavesRoomForTheScale) {
  const Picture off = Draw("--color-by range --image off " + path_);
  const Picture color = Draw("--color-by range " + path_);
  const int scale_px = static_cast<int>(0.17 * kHeight);
  EXPECT_TRUE(off.Part({kWidth - scale_px, 0}, scale_px, kHeight) ==
              color.Part({kWidth - scale_px, 0}, scale_px, kHeight));
}

TEST_F(CameraImageInset, IsSwitchedByAKeyAndFollowsTheFrame) {
  Open({path_});
  ExpectImage(Shown(), 0, PictureKind::kColor);
  Press("Right");
  ExpectImage(Shown(), 1, PictureKind::kColor);
  Press("i");
  ExpectImage(Shown(), 1, PictureKind::kLabel);
  Press("Left i");
  ExpectImage(Shown(), 0, PictureKind::kDepth);
  Press("i");
  EXPECT_TRUE(ArePointsAlike(Shown(), Draw("--image off " + path_)));
  Press("i");
  ExpectImage(Shown(), 0, PictureKind::kColor);
  Press("q");
  EXPECT_EQ(window().ExitStatus(), 0);
}

TEST_F(CameraImageInset, IsNeededOnlyIfAskedFor) {
  const std::string yard = RecordedRun::Yard().path().string();
  EXPECT_TRUE(Draw(yard) == Draw("--image off " + yard));
  const Ended ended = View("--image label --screenshot " + PathOf("out.png") + " " + yard);
  EXPECT_EQ(ended.status, 1);
  EXPECT_EQ(ended.said,
            "error: " + yard + ": images need a sequence whose scenario has a camera\n");
  const Ended unknown = View("--image instance --screenshot " + PathOf("out.png") + " " + yard);
  EXPECT_EQ(unknown.status, 2);
  EXPECT_THAT(unknown.said,
              testing::StartsWith("--image: must be \"color\", \"label\", \"depth\" or "
                                  "\"off\" (got instance)\n"));
}

TEST_F(CameraImageInset, IsNamedWhereItCannotBeRead) {
  std::filesystem::copy(path_, PathOf("run"), std::filesystem::copy_options::recursive);
  const std::string image = PathOf("run/camera/front/color/000001.png");
  std::filesystem::remove(image);
  const Ended ended = View("--frame 1 --screenshot " + PathOf("out.png") + " " + PathOf("run"));
  EXPECT_EQ(ended.status, 1);
  EXPECT_EQ(ended.said, "error: " + image + ": no such file or directory\n");
  EXPECT_FALSE(std::filesystem::exists(PathOf("out.png")));
  // The window goes on with the cloud alone, and with the images that are there.
  Open({PathOf("run")});
  ExpectImage(Shown(), 0, PictureKind::kColor);
  Press("Right");
  EXPECT_TRUE(ArePointsAlike(Shown(), Draw("--frame 1 --image off " + PathOf("run"))));
  Press("i");
  ExpectImage(Shown(), 1, PictureKind::kLabel);
  Press("q");
  EXPECT_EQ(window().ExitStatus(), 0);
}

}  // namespace
}  // namespace railcast
