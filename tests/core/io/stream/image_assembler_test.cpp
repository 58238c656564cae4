#include "core/io/stream/image_receiver.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/io/image/jpeg.h"
#include "core/io/stream/stream_layout.h"
#include "tests/core/io/stream/image_example.h"

namespace railcast {
namespace {

void ExpectImage(const ReceivedImage& image, std::uint32_t frame) {
  const CameraImage sent = NoiseImage(frame);
  EXPECT_EQ(image.frame, frame);
  EXPECT_EQ(image.stamp_ns, sent.stamp_ns);
  EXPECT_EQ(image.size.width_px, sent.width_px);
  EXPECT_EQ(image.size.height_px, sent.height_px);
  EXPECT_EQ(image.jpeg, EncodeJpeg({sent.width_px, sent.height_px}, sent.rgb, 90));
}

// Feeds an image and expects it.
void ExpectGiven(ImageAssembler& assembler,
                 std::uint32_t frame,
                 std::uint32_t run,
                 const DatagramOrigin& origin = {}) {
  const auto images = Feed(assembler, ImageDatagramsOf(frame, run), origin);
  ASSERT_EQ(images.size(), 1U) << frame;
  EXPECT_EQ(images[0].run, run);
  ExpectImage(images[0], frame);
}

TEST(ImageAssembler, GivesEachImageAsItWasEncoded) {
  ImageAssembler assembler;
  for (const std::uint32_t frame : {0U, 2U, 4U}) ExpectGiven(assembler, frame, 1);
  EXPECT_EQ(assembler.counts().complete_images, 3U);
  EXPECT_EQ(assembler.counts().incomplete_images, 0U);
  EXPECT_EQ(assembler.counts().refused_packets, 0U);
}

TEST(ImageAssembler, PutsOvertakenAndDoubledDatagramsInOrder) {
  auto datagrams = ImageDatagramsOf(5);
  std::ranges::reverse(datagrams);
  datagrams.insert(datagrams.begin() + 2, datagrams[0]);
  ImageAssembler assembler;
  const auto images = Feed(assembler, datagrams);
  ASSERT_EQ(images.size(), 1U);
  ExpectImage(images[0], 5);
  EXPECT_TRUE(Feed(assembler, datagrams).empty()) << "once is enough";
  EXPECT_EQ(assembler.counts().received_packets, 2 * datagrams.size());
  EXPECT_EQ(assembler.counts().stray_packets, 0U);
}

TEST(ImageAssembler, CompletesAnImageWhileTheNextHasBegun) {
  const auto first = ImageDatagramsOf(0);
  const auto second = ImageDatagramsOf(1);
  ImageAssembler assembler;
  EXPECT_TRUE(Feed(assembler, {first.begin() + 1, first.end()}).empty());
  EXPECT_TRUE(Feed(assembler, {second.begin(), second.end() - 1}).empty());
  const auto one = Feed(assembler, {first.front()});
  ASSERT_EQ(one.size(), 1U);
  ExpectImage(one[0], 0);
  const auto other = Feed(assembler, {second.back()});
  ASSERT_EQ(other.size(), 1U);
  ExpectImage(other[0], 1);
}

TEST(ImageAssembler, GivesUpAnImageThatLacksADatagram) {
  const auto first = ImageDatagramsOf(0);
  ImageAssembler assembler;
  EXPECT_TRUE(Feed(assembler, {first.begin() + 1, first.end()}).empty());
  ExpectGiven(assembler, 1, 1);
  EXPECT_EQ(assembler.counts().incomplete_images, 1U);
  EXPECT_TRUE(Feed(assembler, {first.front()}).empty()) << "too late";
  // Two later images that have begun are enough, too.
  for (const std::uint32_t frame : {2U, 3U, 4U}) {
    EXPECT_TRUE(Feed(assembler, {ImageDatagramsOf(frame).front()}).empty());
  }
  EXPECT_EQ(assembler.counts().incomplete_images, 2U);
  EXPECT_TRUE(Feed(assembler, ImageDatagramsOf(2)).empty());
  ExpectGiven(assembler, 4, 1);
}

TEST(ImageAssembler, RefusesDatagramsThatContradictTheFirstOfTheirImage) {
  const auto datagrams = ImageDatagramsOf(0);
  ImageAssembler assembler;
  (void)Feed(assembler, {datagrams[0]});
  EXPECT_TRUE(
      Feed(assembler, {With(datagrams[1], offsetof(ImageHead, width_px), 90U),
                       With(datagrams[1], offsetof(ImageHead, stamp_ns), std::int64_t{5}),
                       With(datagrams[1], offsetof(ImageHead, lens), 12.0), datagrams[1] + "x"})
          .empty());
  EXPECT_EQ(assembler.counts().refused_packets, 4U);
  const auto images = Feed(assembler, {datagrams.begin() + 1, datagrams.end()});
  ASSERT_EQ(images.size(), 1U);
  ExpectImage(images[0], 0);
}

TEST(ImageAssembler, FollowsARestart) {
  ImageAssembler assembler;
  ExpectGiven(assembler, 100, 7);
  ExpectGiven(assembler, 0, 8);
  const auto early = ImageDatagramsOf(101, 7);
  ASSERT_LT(early.size(), 16U) << "sixteen strays begin anew";
  EXPECT_TRUE(Feed(assembler, early).empty()) << "on its way since before the restart";
  EXPECT_EQ(assembler.counts().stray_packets, early.size());
  ExpectGiven(assembler, 1, 8);
  // Sixteen in a row are of a sender that began anew without a larger run.
  EXPECT_TRUE(Feed(assembler, std::vector<std::string>(16, ImageDatagramsOf(0, 3)[0])).empty());
  ExpectGiven(assembler, 1, 3);
}

TEST(ImageAssembler, FollowsOneSenderUntilItIsSilent) {
  const DatagramOrigin first{{1, 10}, 0};
  const DatagramOrigin early{{2, 20}, FollowedSender::kHold_ns - 1};
  const DatagramOrigin late{{2, 20}, FollowedSender::kHold_ns};
  ImageAssembler assembler;
  ExpectGiven(assembler, 5, 1, first);
  const auto others = ImageDatagramsOf(9, 99);
  EXPECT_TRUE(Feed(assembler, others, early).empty());
  EXPECT_EQ(assembler.counts().other_sender_packets, others.size());
  ExpectGiven(assembler, 0, 1, late);
}

TEST(ImageAssembler, FollowsOnlyTheSenderThatIsWanted) {
  ImageAssembler assembler(Endpoint{2, 0});
  EXPECT_TRUE(Feed(assembler, ImageDatagramsOf(0), {{1, 10}, 0}).empty());
  ExpectGiven(assembler, 0, 1, {{2, 20}, 0});
}

}  // namespace
}  // namespace railcast
