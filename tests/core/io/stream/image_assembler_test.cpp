#include "core/io/stream/image_receiver.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "core/io/image/jpeg.h"
#include "core/io/stream/stream_datagram.h"
#include "core/io/stream/stream_layout.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/stream/image_example.h"
#include "tests/core/io/stream/live_stream.h"

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

bool IsTaken(const std::string& datagram) {
  return CheckImageDatagram(datagram).has_value();
}

TEST(ImageDatagram, SaysWhatWasSent) {
  const auto datagrams = ImageDatagramsOf(7, 3);
  ASSERT_GT(datagrams.size(), 3U);
  const CameraImage image = NoiseImage(7);
  const std::string jpeg = EncodeJpeg({80, 60}, image.rgb, 90);
  std::string joined;
  for (std::size_t i = 0; i < datagrams.size(); ++i) {
    EXPECT_LE(datagrams[i].size(), kMaxStreamDatagram);
    const auto datagram = CheckImageDatagram(datagrams[i]);
    ASSERT_TRUE(datagram) << i;
    EXPECT_EQ(datagram->head.run, 3U);
    EXPECT_EQ(datagram->head.frame, 7U);
    EXPECT_EQ(datagram->head.stamp_ns, image.stamp_ns);
    EXPECT_EQ(datagram->head.packet, i);
    EXPECT_EQ(datagram->head.num_packets, datagrams.size());
    EXPECT_EQ(datagram->bytes_each, 1232U);
    EXPECT_EQ(datagram->head.width_px, 80U);
    EXPECT_EQ(datagram->head.height_px, 60U);
    joined.append(datagram->piece.begin(), datagram->piece.end());
  }
  EXPECT_EQ(joined, jpeg);
}

TEST(ImageDatagram, IsRefusedIfItIsDamagedOrCutOff) {
  const std::string whole = ImageDatagramsOf(0).back();
  for (std::size_t i = 0; i < whole.size(); ++i) {
    std::string damaged = whole;
    damaged[i] = static_cast<char>(damaged[i] ^ 4);
    EXPECT_FALSE(IsTaken(damaged)) << i;
    EXPECT_FALSE(IsTaken(whole.substr(0, i))) << i;
  }
  EXPECT_FALSE(IsTaken(whole + "x"));
}

TEST(ImageDatagram, IsRefusedIfItContradictsTheProtocol) {
  const std::string first = ImageDatagramsOf(0).front();
  ASSERT_TRUE(IsTaken(With(first, offsetof(ImageHead, frame), std::uint32_t{4})))
      << "a number like any other";
  EXPECT_FALSE(IsTaken(With(first, 0, 'r')));
  EXPECT_FALSE(IsTaken(With(first, offsetof(ImageHead, version), std::uint8_t{2})));
  EXPECT_FALSE(IsTaken(With(first, offsetof(ImageHead, encoding), std::uint8_t{0})));
  EXPECT_FALSE(IsTaken(With(first, offsetof(ImageHead, header_size), std::uint16_t{163})));
  EXPECT_FALSE(IsTaken(With(first, offsetof(ImageHead, width_px), 0U)));
  EXPECT_FALSE(IsTaken(With(first, offsetof(ImageHead, height_px), 0U)));
  EXPECT_TRUE(IsTaken(With(With(first, offsetof(ImageHead, width_px), 4096U),
                           offsetof(ImageHead, height_px), 4096U)));
  EXPECT_FALSE(IsTaken(With(With(first, offsetof(ImageHead, width_px), 4096U),
                            offsetof(ImageHead, height_px), 4097U)));
  EXPECT_FALSE(IsTaken(With(With(first, offsetof(ImageHead, width_px), 0x8000'0000U),
                            offsetof(ImageHead, height_px), 0x8000'0000U)));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(IsTaken(With(first, offsetof(ImageHead, pose), nan)));
  EXPECT_FALSE(IsTaken(With(first, offsetof(ImageHead, pose) + 6 * sizeof nan, 0.5)))
      << "no rotation";
  EXPECT_FALSE(IsTaken(With(first, offsetof(ImageHead, lens), 0.0))) << "focal length";
  EXPECT_FALSE(IsTaken(With(first, offsetof(ImageHead, lens) + 7 * sizeof nan, nan)));
  EXPECT_FALSE(IsTaken(With(first + std::string(100, 'x'), offsetof(ImageHead, frame), 0U)))
      << "too long";
}

TEST(ImageDatagram, IsRefusedIfItsCountsContradictEachOther) {
  const auto datagrams = ImageDatagramsOf(0);
  const std::string& first = datagrams.front();
  const std::string& last = datagrams.back();
  const auto count = static_cast<std::uint16_t>(datagrams.size());
  EXPECT_FALSE(IsTaken(With(first, offsetof(ImageHead, packet), count)));
  EXPECT_FALSE(IsTaken(With(first, offsetof(ImageHead, packet), std::uint16_t{1})))
      << "begins elsewhere";
  EXPECT_FALSE(IsTaken(With(first, offsetof(ImageHead, first_byte), 1U)));
  EXPECT_FALSE(IsTaken(With(last, offsetof(ImageHead, first_byte), 0xFFFF'FFFFU)));
  for (const std::string& datagram : {first, last}) {
    for (const int wrong : {0, count - 1, count + 1, 65'535}) {
      EXPECT_FALSE(IsTaken(
          With(datagram, offsetof(ImageHead, num_packets), static_cast<std::uint16_t>(wrong))))
          << wrong;
    }
    for (const std::uint32_t wrong : {0U, 1232U * (count - 1U), 1232U * count + 1U, 0xFFFF'FFFFU}) {
      EXPECT_FALSE(IsTaken(With(datagram, offsetof(ImageHead, num_bytes), wrong))) << wrong;
    }
  }
}

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
