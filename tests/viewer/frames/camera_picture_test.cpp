#include "viewer/frames/camera_picture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/io/run/camera_files.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/example_run.h"
#include "viewer/color/palette.h"

namespace railcast {
namespace {

using testing::ElementsAre;

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

// Images of two pixels with frames 4, 6 and 8 of frames 3 to 8.
bool MakeTwoPixels(std::uint32_t index, CameraImage& image) {
  if (index % 2 != 0) return false;
  const auto byte = static_cast<std::uint8_t>(index);
  image.width_px = 2;
  image.height_px = 1;
  image.rgb = {byte, 20, 30, 40, 50, byte};
  image.depth_m = {kNone, static_cast<float>(std::sqrt(kNearestDepth_m * kFarthestDepth_m))};
  image.label = {1, 999};
  image.instance = {0, 3};
  return true;
}

/// A run with a camera whose name is also that of a kind of image.
class RecordedPicturesTest : public testing::TestWithParam<const char*> {
 protected:
  RecordedPicturesTest() {
    SequenceSpec spec = ExampleRun(run_, GetParam());
    spec.camera = "label";
    spec.calibration_json = "{}\n";
    (void)RunSequence(spec, MakeExampleFrame, NoHooks(), MakeTwoPixels);
  }

  TemporaryDirectory folder_;
  const std::filesystem::path run_ = folder_.path() / "run";
  RecordedPictures pictures_{run_};
};
INSTANTIATE_TEST_SUITE_P(Formats, RecordedPicturesTest, testing::Values("pcd", "kitti"));

TEST_P(RecordedPicturesTest, AreTheLatestThatWereThereWithTheFrame) {
  // Frame 3, the first, has none, and none was before it.
  EXPECT_EQ(pictures_.At(0, PictureKind::kColor), nullptr);
  const std::vector<std::uint8_t> reds = {4, 4, 6, 6, 8};
  for (std::size_t place = 1; place <= reds.size(); ++place) {
    const auto picture = pictures_.At(place, PictureKind::kColor);
    ASSERT_TRUE(picture) << place;
    const std::uint8_t red = reds[place - 1];
    EXPECT_EQ(picture->width_px, 2U);
    EXPECT_EQ(picture->height_px, 1U);
    EXPECT_THAT(picture->pixels, ElementsAre(Rgb{red, 20, 30}, Rgb{40, 50, red}));
    EXPECT_EQ(picture->title, "label   color   frame " + std::to_string(red));
  }
}

TEST_P(RecordedPicturesTest, ShowLabelsInTheirColours) {
  const auto picture = pictures_.At(1, PictureKind::kLabel);
  ASSERT_TRUE(picture);
  const Rgb rail = ExampleLabels().Find(1)->rgb;
  EXPECT_THAT(picture->pixels, ElementsAre(rail, kNoValueColor));
  EXPECT_EQ(picture->title, "label   label   frame 4");
}

TEST_P(RecordedPicturesTest, ShowDepthsOnALogarithmicScale) {
  const auto picture = pictures_.At(1, PictureKind::kDepth);
  ASSERT_TRUE(picture);
  EXPECT_THAT(picture->pixels, ElementsAre(kNoValueColor, MapColor(ColorMap::kViridis, 0.5)));
  EXPECT_EQ(picture->title, "label   depth, 2 to 200 m, logarithmic   frame 4");
}

TEST_P(RecordedPicturesTest, AreReadOnce) {
  const auto picture = pictures_.At(1, PictureKind::kColor);
  EXPECT_EQ(pictures_.At(2, PictureKind::kColor), picture) << "the same image";
  EXPECT_NE(pictures_.At(3, PictureKind::kColor), picture);
  EXPECT_EQ(pictures_.At(1, PictureKind::kOff), nullptr);
}

TEST_P(RecordedPicturesTest, NameTheFileThatIsMissingOrChanged) {
  const auto at = [&](const char* kind, const char* extension) {
    const std::string number = std::string(GetParam()) == "kitti" ? "000001" : "000004";
    return run_ / "camera/label" / kind / (number + extension);
  };
  std::filesystem::remove(at("color", ".png"));
  EXPECT_EQ(MessageOf([&] { (void)pictures_.At(1, PictureKind::kColor); }),
            at("color", ".png").string() + ": no such file or directory");
  WriteFileWhole(at("depth", ".npy"), "short");
  EXPECT_EQ(MessageOf([&] { (void)pictures_.At(1, PictureKind::kDepth); }),
            at("depth", ".npy").string() + ": must have 136 bytes, as frames.jsonl says (got 5)");
  EXPECT_NE(pictures_.At(1, PictureKind::kLabel), nullptr) << "the others are shown";
}

TEST(RecordedPictures, NeedTheDirectoryOfASequenceWithACamera) {
  const TemporaryDirectory folder;
  (void)RunSequence(ExampleRun(folder.path() / "run"), MakeExampleFrame, NoHooks());
  // Without a camera no file is read, so that a damaged one is not noticed.
  WriteFileWhole(folder.path() / "run/frames.jsonl", "damaged\n");
  for (const auto& source : {folder.path() / "run", folder.path() / "run/frames/000003.pcd",
                             folder.path(), folder.path() / "gone"}) {
    EXPECT_EQ(RecordedPictures(source).At(0, PictureKind::kColor), nullptr) << source;
  }
}

TEST(ScaledPixels, AreTheMeansOfThoseUnderThem) {
  const CameraPicture picture{.width_px = 4,
                              .height_px = 2,
                              .pixels = {{0, 0, 0},
                                         {10, 0, 0},
                                         {200, 1, 9},
                                         {200, 1, 9},  //
                                         {20, 0, 0},
                                         {30, 0, 0},
                                         {200, 1, 9},
                                         {200, 2, 9}},
                              .title = "",
                              .is_blendable = true};
  EXPECT_THAT(ScaledPixels(picture, {2, 1}), ElementsAre(Rgb{15, 0, 0}, Rgb{200, 1, 9}));
}

TEST(ScaledPixels, AreNeverMixedWhereColoursHaveMeanings) {
  const CameraPicture picture{
      .width_px = 3, .height_px = 1, .pixels = {{1, 0, 0}, {2, 0, 0}, {3, 0, 0}}, .title = ""};
  EXPECT_THAT(ScaledPixels(picture, {1, 1}), ElementsAre(Rgb{2, 0, 0}));
  EXPECT_THAT(ScaledPixels(picture, {6, 1}), ElementsAre(Rgb{1, 0, 0}, Rgb{1, 0, 0}, Rgb{2, 0, 0},
                                                         Rgb{2, 0, 0}, Rgb{3, 0, 0}, Rgb{3, 0, 0}));
}

}  // namespace
}  // namespace railcast
