#include "core/io/stream/stream_datagram.h"

#include <gtest/gtest.h>

#include <limits>

#include "core/io/image/jpeg.h"
#include "core/io/stream/stream_layout.h"
#include "tests/core/io/stream/image_example.h"

namespace railcast {
namespace {

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

}  // namespace
}  // namespace railcast
