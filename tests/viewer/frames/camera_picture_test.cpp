#include "viewer/frames/camera_picture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/io/image/jpeg.h"
#include "core/io/run/camera_files.h"
#include "core/io/stream/stream_layout.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/stream/image_example.h"
#include "tests/core/io/stream/live_stream.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/example_run.h"
#include "viewer/color/palette.h"
#include "viewer/frames/live_frames.h"

namespace railcast {
namespace {

using testing::ElementsAre;
using testing::EndsWith;

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

/// A live source with images, and what sends to it. Frames and images of one number have one stamp.
class LivePicturesTest : public testing::Test {
 protected:
  void SendFrame(std::uint32_t frame) {
    stream_.Send(frame);
    ASSERT_TRUE(Eventually([&] { return frames_.Poll(); })) << frame;
  }
  void SendPicture(std::uint32_t frame, std::uint32_t run = 0) {
    SendImage(frame, run, camera_);
    ASSERT_TRUE(Eventually([&] { return frames_.PollImages(); })) << frame;
  }
  [[nodiscard]] std::shared_ptr<const CameraPicture> ColorAt(std::size_t place) {
    return frames_.Picture(place, PictureKind::kColor);
  }
  /// Expects the picture of a place to be the image that was sent with a frame.
  void ExpectPicture(std::size_t place, std::uint32_t frame) {
    const auto picture = ColorAt(place);
    ASSERT_TRUE(picture) << place;
    EXPECT_EQ(picture->title, "color   frame " + std::to_string(frame));
    EXPECT_EQ(picture->width_px, 80U);
    EXPECT_EQ(picture->height_px, 60U);
    const std::string jpeg = EncodeJpeg({80, 60}, NoiseImage(frame).rgb, 90);
    EXPECT_EQ(picture->pixels, MakeColorPicture(DecodeJpegRgb(jpeg, {80, 60})).pixels);
  }

  LiveFrames frames_{"udp://here", kAnyLoopbackPort, {}, kAnyLoopbackPort};
  LiveStream stream_{frames_.at()};
  UdpSender camera_{{*frames_.images_at()}, 0};
};

TEST_F(LivePicturesTest, AreTheLatestThatWereThereAtTheFramesStamp) {
  for (std::uint32_t frame = 0; frame < 5; ++frame) SendFrame(frame);
  SendPicture(1);
  SendPicture(3);
  EXPECT_EQ(ColorAt(0), nullptr) << "before the first image";
  ExpectPicture(1, 1);
  ExpectPicture(2, 1);
  ExpectPicture(3, 3);
  ExpectPicture(4, 3);
  EXPECT_EQ(ColorAt(4), ColorAt(3)) << "decoded once";
  EXPECT_EQ(ColorAt(5), nullptr) << "no such frame";
  EXPECT_EQ(frames_.Picture(3, PictureKind::kOff), nullptr);
}

TEST_F(LivePicturesTest, AreForGoodOnceAnImageOfTheSameTimeOrLaterIsThere) {
  for (std::uint32_t frame = 0; frame < 3; ++frame) SendFrame(frame);
  EXPECT_EQ(frames_.FirstWhole(0, true), std::nullopt);
  EXPECT_EQ(frames_.FirstWhole(2, false), 2U);
  EXPECT_TRUE(frames_.MayGetPicture(0));
  SendPicture(0);
  EXPECT_EQ(frames_.FirstWhole(0, true), 0U);
  EXPECT_EQ(frames_.FirstWhole(1, true), std::nullopt);
  EXPECT_FALSE(frames_.MayGetPicture(0));
  EXPECT_TRUE(frames_.MayGetPicture(1));
  SendPicture(2);
  EXPECT_EQ(frames_.FirstWhole(1, true), 1U) << "none is skipped";
  SendFrame(3);
  EXPECT_EQ(frames_.FirstWhole(3, true), std::nullopt) << "its own may still come";
  EXPECT_FALSE(frames_.MayGetPicture(4)) << "no such frame";
  SendPicture(4);
  EXPECT_EQ(frames_.FirstWhole(3, true), 3U);
  ExpectPicture(3, 2);
}

TEST_F(LivePicturesTest, AreOfTheFramesRun) {
  SendFrame(5);
  SendPicture(5, 1);
  EXPECT_EQ(ColorAt(0), nullptr);
  StreamSpec next{.run = 1};
  stream_.Restart(next);
  SendFrame(5);
  EXPECT_EQ(ColorAt(0), nullptr);
  ExpectPicture(1, 5);
}

TEST_F(LivePicturesTest, AreThoseOfTheLast64Images) {
  SendFrame(0);
  for (std::uint32_t frame = 0; frame < 64; ++frame) SendPicture(frame);
  ExpectPicture(0, 0);
  SendPicture(64);
  EXPECT_EQ(ColorAt(0), nullptr);
}

TEST_F(LivePicturesTest, AreOnlyInColour) {
  SendFrame(0);
  SendPicture(0);
  EXPECT_EQ(MessageOf([&] { (void)frames_.Picture(0, PictureKind::kLabel); }),
            "udp://here: images of kind label are not sent live");
  EXPECT_EQ(MessageOf([&] { (void)frames_.Picture(0, PictureKind::kDepth); }),
            "udp://here: images of kind depth are not sent live");
}

TEST_F(LivePicturesTest, NameTheImageThatIsDamaged) {
  SendFrame(0);
  Datagrams datagrams;
  for (const std::string& datagram : ImageDatagramsOf(0, 0)) {
    const std::string wider = With(datagram, offsetof(ImageHead, width_px), 90U);
    datagrams.items.push_back({datagrams.bytes.size(), static_cast<std::uint16_t>(wider.size())});
    datagrams.bytes.insert(datagrams.bytes.end(), wider.begin(), wider.end());
  }
  camera_.Send(datagrams, datagrams.items);
  ASSERT_TRUE(Eventually([&] { return frames_.PollImages(); }));
  EXPECT_EQ(MessageOf([&] { (void)ColorAt(0); }),
            "udp://here: image of frame 0: must have 90 x 60 pixels (got 80 x 60)");
}

TEST_F(LivePicturesTest, SayWhatIsMissing) {
  SendFrame(0);
  EXPECT_THAT(frames_.StatusText(), EndsWith("   0 packets lost   no image has come"));
  EXPECT_EQ(frames_.PictureNeeds(), "no image of this frame has come");
  SendPicture(0);
  EXPECT_THAT(frames_.StatusText(), EndsWith("   0 packets lost"));
  Datagrams datagrams;
  EncodeImage(1, 0, datagrams);
  camera_.Send(datagrams, std::span(datagrams.items).subspan(1));
  SendPicture(2);
  EXPECT_THAT(frames_.StatusText(), EndsWith("   1 images lost"));
}

TEST(LivePictures, NeedAPort) {
  LiveFrames frames("udp://here", kAnyLoopbackPort);
  LiveStream stream(frames.at());
  stream.Send(0);
  ASSERT_TRUE(Eventually([&] { return frames.Poll(); }));
  EXPECT_EQ(frames.images_at(), std::nullopt);
  EXPECT_FALSE(frames.PollImages());
  EXPECT_EQ(frames.Picture(0, PictureKind::kColor), nullptr);
  EXPECT_EQ(frames.PictureNeeds(), "images of a live source need --image-port");
  EXPECT_EQ(
      MessageOf([&] { const LiveFrames second("udp://there", kAnyLoopbackPort, {}, frames.at()); }),
      "cannot listen: Address already in use (got " + EndpointText(frames.at()) + ")");
}

TEST(LivePictures, ComeFromAnyPortOfTheWantedSender) {
  const Endpoint nobody{kAnyLoopbackPort.address, 1};
  LiveFrames frames("udp://here", kAnyLoopbackPort, {.from = nobody}, kAnyLoopbackPort);
  UdpSender camera({*frames.images_at()}, 0);
  SendImage(0, 0, camera);
  EXPECT_TRUE(Eventually([&] { return frames.PollImages(); }));
}

}  // namespace
}  // namespace railcast
