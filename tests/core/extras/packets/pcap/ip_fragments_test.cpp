#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include "core/extras/packets/pcap/pcap_reader.h"
#include "railcast/io/recording.h"
#include "tests/core/extras/packets/pcap/made_capture.h"
#include "tests/core/extras/packets/velodyne/made_scan.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/recording/read_all.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/support/captures.h"
#include "tests/support/faults.h"
#include "tests/support/frame_bytes.h"
#include "tests/support/run_command.h"
#include "tests/support/sensor_file.h"

namespace railcast {
namespace {

std::string Counted(std::size_t size, int from) {
  std::string text;
  for (std::size_t i = 0; i < size; ++i) {
    text += static_cast<char>(from + 7 * static_cast<int>(i));
  }
  return text;
}

struct ReadCapture {
  std::vector<std::string> payloads;
  std::vector<std::size_t> packets;
  std::size_t num_torn{};
};

ReadCapture ReadFragments(const std::vector<CapturedFrame>& frames) {
  const TemporaryDirectory directory;
  PcapReader reader(WriteCapture(directory.path() / "a.pcap", frames));
  ReadCapture read;
  while (const auto datagram = reader.Next()) {
    read.payloads.emplace_back(datagram->payload.begin(), datagram->payload.end());
    read.packets.push_back(datagram->packet);
  }
  read.num_torn = reader.num_torn();
  return read;
}

TEST(IpFragments, ArePutTogetherInWhateverOrderTheyCome) {
  const std::string payload = Counted(3000, 3);
  const std::string udp = Udp(payload);
  std::vector<CapturedFrame> frames = {
      {FragmentOf(udp, 0, 1480)}, {FragmentOf(udp, 1480, 1480)}, {FragmentOf(udp, 2960, 1480)}};
  std::vector<int> order = {0, 1, 2};
  do {
    const ReadCapture read = ReadFragments({frames[static_cast<std::size_t>(order[0])],
                                            frames[static_cast<std::size_t>(order[1])],
                                            frames[static_cast<std::size_t>(order[2])]});
    EXPECT_THAT(read.payloads, testing::ElementsAre(payload));
    EXPECT_THAT(read.packets, testing::ElementsAre(2U)) << "that of the last to come";
    EXPECT_EQ(read.num_torn, 0U);
  } while (std::ranges::next_permutation(order).found);
}

TEST(IpFragments, OfIpv6ArePutTogetherInWhateverOrderTheyCome) {
  const std::string payload = Counted(3000, 3);
  const std::string udp = Udp(payload);
  // Those of another packet of the same addresses, and of IPv4, between them.
  const std::string other = Udp(Counted(100, 1));
  const ReadCapture read = ReadFragments({{FragmentOfIpv6(udp, 2880, 1440)},
                                          {FragmentOfIpv6(other, 0, 64, 8)},
                                          {FragmentOfIpv6(udp, 0, 1440)},
                                          {FragmentOf(other, 0, 64)},
                                          {FragmentOfIpv6(udp, 1440, 1440)},
                                          {FragmentOfIpv6(other, 64, 64, 8)}});
  EXPECT_THAT(read.payloads, testing::ElementsAre(payload, Counted(100, 1)));
  EXPECT_THAT(read.packets, testing::ElementsAre(4U, 5U));
  EXPECT_EQ(read.num_torn, 1U);
}

TEST(IpFragments, OfSeveralDatagramsMayAlternateAndBeCapturedTwice) {
  const std::string a = Udp(Counted(100, 1));
  const std::string b = Udp(Counted(90, 2));
  const ReadCapture read = ReadFragments({{FragmentOf(a, 0, 64, 1)},
                                          {FragmentOf(b, 0, 56, 2)},
                                          {FragmentOf(a, 0, 64, 1)},
                                          {FragmentOf(b, 56, 64, 2)},
                                          {FragmentOf(Udp("whole"), 0, 64, 3)},
                                          {FragmentOf(a, 64, 64, 1)}});
  EXPECT_THAT(read.payloads, testing::ElementsAre(Counted(90, 2), "whole", Counted(100, 1)));
  EXPECT_EQ(read.num_torn, 0U);
}

TEST(IpFragments, MayBeCapturedTwiceOneByOne) {
  const std::string udp = Udp(Counted(100, 1));
  const std::string first = FragmentOf(udp, 0, 64);
  const std::string last = FragmentOf(udp, 64, 64);
  const ReadCapture read = ReadFragments({{first}, {first}, {last}, {last}});
  EXPECT_THAT(read.payloads, testing::ElementsAre(Counted(100, 1)));
  EXPECT_EQ(read.num_torn, 0U);
  // A fragment of another packet of that number.
  const std::string other = FragmentOf(Udp(Counted(100, 2)), 64, 64);
  EXPECT_EQ(ReadFragments({{first}, {last}, {other}}).num_torn, 1U);
}

TEST(IpFragments, LoseTheirDatagramWhereOneIsMissing) {
  const std::string udp = Udp(Counted(100, 1));
  const ReadCapture read = ReadFragments(
      {{FragmentOf(udp, 0, 32)}, {FragmentOf(udp, 64, 64)}, {FragmentOf(Udp("whole"), 0, 64, 8)}});
  EXPECT_THAT(read.payloads, testing::ElementsAre("whole"));
  EXPECT_EQ(read.num_torn, 1U);
}

// Identifications are used again: what comes later belongs to another datagram.
TEST(IpFragments, AreNotJoinedOverMoreThanASecond) {
  const std::string old = Udp(Counted(100, 1));
  const std::string udp = Udp(Counted(100, 2));
  const ReadCapture apart =
      ReadFragments({{FragmentOf(old, 0, 64), 0}, {FragmentOf(old, 64, 64), 1'000'001}});
  EXPECT_THAT(apart.payloads, testing::IsEmpty());
  EXPECT_EQ(apart.num_torn, 2U);
  const ReadCapture near = ReadFragments({{FragmentOf(old, 0, 64), 0},
                                          {FragmentOf(udp, 0, 64), 1'000'001},
                                          {FragmentOf(udp, 64, 64), 2'000'001}});
  EXPECT_THAT(near.payloads, testing::ElementsAre(Counted(100, 2)));
  EXPECT_EQ(near.num_torn, 1U);
}

TEST(IpFragments, OfMoreThan64UnfinishedDatagramsGiveUpTheOldest) {
  const std::string udp = Udp(Counted(100, 1));
  std::vector<CapturedFrame> frames;
  for (std::size_t i = 0; i < 65; ++i) frames.push_back({FragmentOf(udp, 0, 64, i)});
  frames.push_back({FragmentOf(udp, 64, 64, 0)});
  frames.push_back({FragmentOf(udp, 64, 64, 64)});
  const ReadCapture read = ReadFragments(frames);
  EXPECT_THAT(read.packets, testing::ElementsAre(66U));
  // All that were begun but the last, and the rest of the first, which begins another one.
  EXPECT_EQ(read.num_torn, 65U);
}

TEST(IpFragments, ThatContradictEachOtherAreRefused) {
  const std::string udp = Udp(Counted(100, 1));
  const TemporaryDirectory directory;
  const auto said = [&](const std::vector<std::string>& frames) {
    std::vector<CapturedFrame> captured;
    for (const std::string& frame : frames) captured.push_back({frame});
    const auto file = WriteCapture(directory.path() / "a.pcap", captured);
    return MessageBehind(file.string() + ": packet 1: ", [&] { (void)PacketsInCapture(file); });
  };
  EXPECT_EQ(said({FragmentOf(udp, 0, 64), FragmentOf(udp, 32, 64)}),
            "an IP fragment must not overlap another (got bytes 32 to 96 beside 0 to 64)");
  EXPECT_EQ(said({FragmentOf(udp, 0, 64), FragmentOf(Udp(Counted(100, 2)), 0, 64)}),
            "an IP fragment must not overlap another (got bytes 0 to 64 beside 0 to 64)");
  EXPECT_EQ(said({FragmentOf(udp, 64, 64), FragmentOf(Udp(Counted(200, 1)), 104, 8)}),
            "an IP fragment must lie before the end of its packet (got bytes 104 to 112, the end "
            "at 108)");
  EXPECT_EQ(said({FragmentOf(Udp(Counted(200, 1)), 104, 8), FragmentOf(udp, 64, 64)}),
            "an IP fragment must lie before the end of its packet (got bytes 64 to 108, the end "
            "at 108)");
  const std::string too_long(70'000, 'a');
  EXPECT_EQ(said({FragmentOf(udp, 0, 64), FragmentOf(too_long, 65'528, 64)}),
            "an IP fragment must end within 65535 bytes (got 65592)");
}

TEST(IpFragments, GiveWhatTsharkPutsTogether) {
  if (!HasTshark()) GTEST_SKIP() << "tshark is missing";
  std::vector<CapturedFrame> frames;
  for (std::size_t i = 0; i < 20; ++i) {
    const std::string udp = Udp(Counted(500 + 777 * i, static_cast<int>(i)));
    std::vector<CapturedFrame> pieces;
    for (std::size_t begin = 0; begin < udp.size(); begin += 1480) {
      pieces.push_back({FragmentOf(udp, begin, 1480, i), 100 * i});
    }
    if (i % 3 == 1) std::ranges::reverse(pieces);
    if (i == 11) pieces.erase(pieces.begin() + 2);
    frames.insert(frames.end(), pieces.begin(), pieces.end());
  }
  const TemporaryDirectory directory;
  const auto file = WriteCapture(directory.path() / "a.pcap", frames);
  const Ended tshark =
      RunCommand("tshark -r " + file.string() + " -Y udp -T fields -e udp.payload 2>/dev/null");
  std::istringstream lines(tshark.said);
  std::vector<std::string> theirs;
  for (std::string line; std::getline(lines, line);) theirs.push_back(line);
  std::vector<std::string> ours;
  for (const std::string& payload : ReadFragments(frames).payloads) {
    std::string& text = ours.emplace_back();
    for (const char byte : payload) {
      constexpr const char* kDigits = "0123456789abcdef";
      text += kDigits[static_cast<unsigned char>(byte) >> 4U];
      text += kDigits[static_cast<unsigned char>(byte) & 0xFU];
    }
  }
  EXPECT_EQ(ours.size(), 19U);
  EXPECT_EQ(ours, theirs);
}

TEST(IpFragments, OfASensorsPacketsGiveItsFrames) {
  const MadeScan scan(ReadSensor("vlp16"));
  const Datagrams datagrams =
      EncodeAll("vlp16", scan, {scan.MakeFrame(0, 1), scan.MakeFrame(1, 1)});
  std::vector<CapturedFrame> whole;
  std::vector<CapturedFrame> torn;
  for (const Datagrams::Item& item : datagrams.items) {
    const std::span<const char> payload = datagrams.BytesOf(item);
    const std::string udp = Udp({payload.begin(), payload.end()});
    whole.push_back({FragmentOf(udp, 0, udp.size(), whole.size())});
    for (std::size_t begin = 0; begin < udp.size(); begin += 560) {
      torn.push_back({FragmentOf(udp, begin, 560, whole.size())});
    }
  }
  const TemporaryDirectory directory;
  const auto expected = ReadAll(WriteCapture(directory.path() / "whole.pcap", whole));
  const auto read = ReadAll(WriteCapture(directory.path() / "torn.pcap", torn));
  ASSERT_EQ(expected.size(), 2U);
  ASSERT_EQ(read.size(), 2U);
  for (std::size_t i = 0; i < read.size(); ++i) {
    EXPECT_TRUE(FrameBytes(read[i].frame) == FrameBytes(expected[i].frame)) << i;
  }
}

// A filter on a port keeps the first fragments only: no other has a port.
TEST(IpFragments, OfWhichOnlyTheFirstWereCapturedAreNamed) {
  const std::string udp = Udp(Counted(2000, 1));
  const TemporaryDirectory directory;
  const auto file = WriteCapture(directory.path() / "a.pcap",
                                 {{FragmentOf(udp, 0, 1480, 1)}, {FragmentOf(udp, 0, 1480, 2)}});
  EXPECT_THAT(MessageOf([&] { (void)OpenRecording(file); }),
              testing::EndsWith("(got no whole UDP datagram, and 2 that lack IP fragments)"));
}

}  // namespace
}  // namespace railcast
