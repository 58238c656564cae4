#include "core/io/stream/image_receiver.h"

#include <gtest/gtest.h>

#include "core/io/image/jpeg.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/stream/image_example.h"
#include "tests/core/io/stream/live_stream.h"

namespace railcast {
namespace {

TEST(ImageReceiver, GivesTheImagesThatASenderSends) {
  ImageReceiver receiver(kAnyLoopbackPort);
  UdpSender sender({receiver.at()}, 0);
  for (std::uint32_t frame = 0; frame < 10; ++frame) {
    SendImage(frame, 1, sender);
    std::vector<ReceivedImage> images;
    ASSERT_TRUE(Eventually([&] { return !(images = receiver.Take()).empty(); }));
    ASSERT_EQ(images.size(), 1U);
    EXPECT_EQ(images[0].frame, frame);
    EXPECT_EQ(images[0].jpeg, EncodeJpeg({80, 60}, NoiseImage(frame).rgb, 90));
  }
  EXPECT_EQ(receiver.counts().complete_images, 10U);
}

TEST(ImageReceiver, KeepsTheLatestImagesForASlowConsumer) {
  ImageReceiver receiver(kAnyLoopbackPort);
  UdpSender sender({receiver.at()}, 0);
  for (std::uint32_t frame = 0; frame < 6; ++frame) {
    SendImage(frame, 1, sender);
    ASSERT_TRUE(Eventually([&] { return receiver.counts().complete_images == frame + 1; }));
  }
  const auto images = receiver.Take();
  ASSERT_EQ(images.size(), ImageReceiver::kMaxWaitingImages);
  for (std::uint32_t i = 0; i < images.size(); ++i) EXPECT_EQ(images[i].frame, 2 + i);
}

TEST(ImageReceiver, SaysThatAPortIsTaken) {
  const ImageReceiver first(kAnyLoopbackPort);
  EXPECT_EQ(MessageOf([&] { const ImageReceiver second(first.at()); }),
            "cannot listen: Address already in use (got " + EndpointText(first.at()) + ")");
}

}  // namespace
}  // namespace railcast
