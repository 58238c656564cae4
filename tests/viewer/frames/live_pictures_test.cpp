
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/io/image/jpeg.h"
#include "core/io/stream/stream_layout.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/stream/image_example.h"
#include "tests/core/io/stream/live_stream.h"
#include "viewer/frames/live_frames.h"

namespace railcast {
namespace {

using testing::EndsWith;

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
