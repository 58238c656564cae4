#include "core/extras/packets/recording/packet_recording.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "core/io/recording/source_choice.h"
#include "core/io/write_file.h"
#include "tests/core/extras/packets/hesai/made_packet.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/support/captures.h"
#include "tests/support/hesai_bag.h"
#include "tests/support/made_datagrams.h"

namespace railcast {
namespace {

/// All turns of a recording.
std::vector<std::deque<RecordedDatagram>> AllTurnsOf(PacketRecording& recording) {
  std::vector<std::deque<RecordedDatagram>> turns;
  for (auto turn = recording.NextTurn(); !turn.empty(); turn = recording.NextTurn()) {
    turns.push_back(std::move(turn));
  }
  return turns;
}

void ExpectSameDatagram(const RecordedDatagram& got, const CapturedDatagram& expected) {
  EXPECT_TRUE(std::ranges::equal(got.bytes, expected.payload));
  EXPECT_EQ(got.time_ns, expected.time_ns);
}

class RealPackets : public testing::TestWithParam<const char*> {};

TEST_P(RealPackets, AreReturnedByteForByteInTheirOrder) {
  const auto file = std::filesystem::path(RAILCAST_SHARED_DATA_DIR) / GetParam();
  if (!exists(file)) GTEST_SKIP() << file << " is not there";
  PacketRecording recording(*FindCapture(file));
  const auto turns = AllTurnsOf(recording);
  PcapReader reader(file);
  for (const auto& turn : turns) {
    for (const RecordedDatagram& datagram : turn) {
      const auto expected = reader.Next();
      ASSERT_TRUE(expected);
      ExpectSameDatagram(datagram, *expected);
      EXPECT_EQ(datagram.port, expected->destination_port);
    }
  }
  EXPECT_FALSE(reader.Next());
  EXPECT_EQ(recording.num_left_out(), 0U);
  std::size_t num_frames = 0;
  for (const auto frames = OpenRecording(file); frames->Next();) ++num_frames;
  // The last packet may end a turn and begin one that no datagram follows.
  EXPECT_THAT(num_frames, testing::AnyOf(turns.size(), turns.size() + 1));
}

INSTANTIATE_TEST_SUITE_P(Captures,
                         RealPackets,
                         testing::Values("lidar_packets_nebula/vlp16_dual.pcap",
                                         "lidar_packets_nebula/vlp32c_single.pcap",
                                         "lidar_packets_nebula/vls128_single.pcap",
                                         "lidar_packets_nebula/pandar64.pcap",
                                         "lidar_ouster/OS-2-128-U1_v2.3.0_1024x10.pcap",
                                         "lidar_ouster/OS-1-128_v2.3.0_1024x10_lb_n3.pcap"),
                         [](const auto& test) { return "Number" + std::to_string(test.index); });

TEST(PacketRecording, OfABagGoesToThePortOfItsSensor) {
  if (const auto why = WhyNoHesaiBag("xt32"); !why.empty()) GTEST_SKIP() << why;
  PacketRecording recording(*FindBagPackets({HesaiBag("xt32")}));
  EXPECT_EQ(recording.name(), "XT32");
  const auto packets = FindBagPackets({HesaiBag("xt32")})->open();
  for (const auto& turn : AllTurnsOf(recording)) {
    for (const RecordedDatagram& datagram : turn) {
      const auto expected = packets->Next();
      ASSERT_TRUE(expected);
      ExpectSameDatagram(datagram, *expected);
      EXPECT_EQ(datagram.port, 2368);
    }
  }
  EXPECT_FALSE(packets->Next());
}

/// A datagram of a made capture.
struct MadeDatagram {
  char host{};                ///< The last byte of its address, 192.168.1.X.
  std::size_t num_packets{};  ///< Of a Pandar64, each a turn of its own; 0 = a report.
};

/// @param number Of the first packet.
std::vector<char> PayloadOf(const MadeDatagram& made, std::uint32_t number) {
  if (made.num_packets == 0) return std::vector<char>(512, made.host);
  std::vector<char> payload;
  for (std::uint32_t i = 0; i < made.num_packets; ++i) {
    const std::vector<char> packet = NumberedPacket(number + i);
    payload.insert(payload.end(), packet.begin(), packet.end());
  }
  return payload;
}

/// Writes a capture of datagrams that are a millisecond apart.
std::filesystem::path WriteHosts(const std::filesystem::path& file,
                                 const std::vector<MadeDatagram>& made) {
  Datagrams datagrams;
  for (std::size_t i = 0; i < made.size(); ++i) {
    AddDatagram(PayloadOf(made[i], static_cast<std::uint32_t>(10 * i)), datagrams,
                made[i].num_packets == 0 ? DatagramPort::kPosition : DatagramPort::kData,
                static_cast<std::int64_t>(i) * 1'000'000);
  }
  std::string bytes = ReadFileWhole(WriteDatagrams(file, datagrams));
  constexpr std::size_t kRecordHeader = 16;
  constexpr std::size_t kHeaders = 42;            // Of Ethernet, IP and UDP.
  constexpr std::size_t kLastOfSource = 14 + 15;  // In these.
  std::size_t record = 24;
  for (std::size_t i = 0; i < made.size(); ++i) {
    bytes[record + kRecordHeader + kLastOfSource] = made[i].host;
    record += kRecordHeader + kHeaders + datagrams.items[i].size;
  }
  WriteFileWhole(file, bytes);
  return file;
}

constexpr char kRoof = 7;
constexpr char kFront = 9;
constexpr char kOther = 5;

/// The hosts that the datagrams are of: reports have that in each byte, packets go without.
std::string HostsOf(const std::deque<RecordedDatagram>& turn) {
  std::string hosts;
  for (const RecordedDatagram& datagram : turn) {
    hosts += datagram.port == 2368 ? "p" : std::to_string(datagram.bytes.front());
  }
  return hosts;
}

const std::vector<MadeDatagram> kTwoSensors = {{kOther, 0}, {kRoof, 0},  {kRoof, 1}, {kFront, 0},
                                               {kFront, 1}, {kFront, 0}, {kRoof, 1}, {kOther, 0}};

TEST(PacketRecording, HoldsAllThatSensorsSentAndNothingOfOthers) {
  const TemporaryDirectory folder;
  PacketRecording recording(*FindCapture(WriteHosts(folder.path() / "a.pcap", kTwoSensors)));
  // The second packet of the first sensor ends its turn.
  EXPECT_EQ(HostsOf(recording.NextTurn()), "7pp9p");
  EXPECT_TRUE(recording.NextTurn().empty());
  // Two of others, and the report of the second sensor before its first packet.
  EXPECT_EQ(recording.num_left_out(), 3U);
  EXPECT_EQ(recording.port(), 2368);
}

TEST(PacketRecording, HoldsThoseOfOneSensorIfToldSo) {
  const TemporaryDirectory folder;
  const auto place = *FindCapture(WriteHosts(folder.path() / "a.pcap", kTwoSensors));
  auto front = place;
  front.sensor = ParseSender("192.168.1.9");
  PacketRecording recording(front);
  EXPECT_EQ(HostsOf(recording.NextTurn()), "9p9");
  auto other = place;
  other.sensor = ParseSender("192.168.1.5");
  EXPECT_EQ(MessageOf([&] { PacketRecording nobody(other); }),
            place.source.string() + ": holds 2 sensors: Pandar64 at 192.168.1.7, Pandar64 at " +
                "192.168.1.9; must be one of them (got 192.168.1.5)");
}

TEST(PacketRecording, CutsWhatOffloadMerged) {
  const TemporaryDirectory folder;
  PacketRecording recording(
      *FindCapture(WriteHosts(folder.path() / "a.pcap", {{kRoof, 3}, {kRoof, 1}})));
  const auto turns = AllTurnsOf(recording);
  // A turn has the packet that completes it.
  ASSERT_EQ(turns.size(), 3U);
  ASSERT_EQ(turns[0].size(), 2U);
  EXPECT_EQ(turns[0][0].bytes, NumberedPacket(0));
  EXPECT_EQ(turns[0][1].bytes, NumberedPacket(1));
  EXPECT_EQ(turns[1][0].bytes, NumberedPacket(2));
  EXPECT_EQ(turns[1][0].time_ns, turns[0][0].time_ns);
  EXPECT_EQ(turns[2][0].bytes, NumberedPacket(10));
}

TEST(PacketRecording, HoldsWhatIsWholeOfADamagedCapture) {
  const TemporaryDirectory folder;
  const auto file = WriteHosts(folder.path() / "a.pcap", {{kRoof, 1}, {kRoof, 0}, {kRoof, 1}});
  std::string bytes = ReadFileWhole(file);
  const std::size_t third = 24 + 16 + 42 + 1198 + 16 + 42 + 512;
  bytes[third + 11] = '\x7F';  // The size that is said to be kept.
  WriteFileWhole(file, bytes);
  PacketRecording recording(*FindCapture(file));
  EXPECT_EQ(HostsOf(recording.NextTurn()), "p7");
  EXPECT_THAT(MessageOf([&] { static_cast<void>(recording.NextTurn()); }),
              testing::StartsWith(file.string() + ": packet 2: "));
}

TEST(PacketRecording, IsOfCapturesAndTopicsOfPacketsOnly) {
  EXPECT_FALSE(FindCapture("run.mcap"));
  EXPECT_TRUE(FindCapture("run.pcapng"));
}

}  // namespace
}  // namespace railcast
