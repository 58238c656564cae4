#include "core/extras/packets/recording/packet_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <functional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "core/extras/packets/pcap/pcap_reader.h"
#include "core/extras/packets/recording/capture_sensor.h"
#include "core/extras/packets/spinning/spinning_decoder.h"
#include "tests/core/extras/packets/hesai/made_packet.h"
#include "tests/core/extras/packets/pcap/made_capture.h"
#include "tests/core/extras/packets/velodyne/made_scan.h"
#include "tests/core/io/recording/read_all.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/support/frame_bytes.h"
#include "tests/support/made_datagrams.h"
#include "tests/support/sensor_file.h"

namespace railcast {
namespace {

/// The packets of turns of a sensor.
/// @param sensor Its file; empty: the format's.
std::vector<std::string> Turns(std::uint32_t num, const char* format, const ScanSpec& sensor) {
  const MadeScan scan(sensor);
  const std::uint32_t returns = ReturnModeOfFormat(format) == ReturnMode::kDual ? 2 : 1;
  std::vector<Frame> frames;
  for (std::uint32_t i = 0; i < num; ++i) frames.push_back(scan.MakeFrame(i, returns));
  return DataTexts(EncodeAll(format, scan, frames));
}
std::vector<std::string> Turns(std::uint32_t num,
                               const char* format = "vlp16",
                               const std::string& sensor = {}) {
  return Turns(num, format, ReadSensor(sensor.empty() ? std::string(SensorOf(format)) : sensor));
}

std::vector<std::string> TwoTurns(const char* format = "vlp16") {
  return Turns(2, format);
}

/// The packets whose first azimuth, in 0.01 deg, lies from 12000 to 24000.
std::vector<std::string> WindowOf(const std::vector<std::string>& packets) {
  std::vector<std::string> within;
  for (const std::string& packet : packets) {
    const auto azimuth = LoadAt<std::uint16_t>(packet.data() + kAzimuthPlace);
    if (azimuth > 12'000 && azimuth < 24'000) within.push_back(packet);
  }
  return within;
}

/// The frames of a capture of these packets, each millisecond one, and what is said of it.
struct ReadTurns {
  std::vector<RecordedFrame> frames;
  std::vector<Remark> remarks;

  [[nodiscard]] std::size_t Number(RemarkKind kind) const {
    const auto found = std::ranges::find(remarks, kind, &Remark::kind);
    return found == remarks.end() ? 0 : found->number;
  }
};

ReadTurns ReadPackets(const std::vector<std::string>& payloads) {
  std::vector<CapturedFrame> frames;
  for (const std::string& payload : payloads) {
    frames.push_back({EthernetOf(IpOf(payload)), 1000 * frames.size()});
  }
  const TemporaryDirectory directory;
  const auto recording = OpenRecording(WriteCapture(directory.path() / "a.pcap", frames));
  ReadTurns read{ReadAll(*recording), {}};
  read.remarks = recording->info().remarks->List();
  return read;
}

void ExpectSameFrames(const ReadTurns& got, const ReadTurns& expected) {
  ASSERT_EQ(got.frames.size(), expected.frames.size());
  for (std::size_t i = 0; i < got.frames.size(); ++i) {
    EXPECT_TRUE(FrameBytes(got.frames[i].frame) == FrameBytes(expected.frames[i].frame)) << i;
  }
}

class OrderedPackets : public testing::TestWithParam<const char*> {};

TEST_P(OrderedPackets, ThatComeSeveralTimesAreTakenOnce) {
  const auto packets = TwoTurns(GetParam());
  const ReadTurns plain = ReadPackets(packets);
  EXPECT_TRUE(plain.remarks.empty());
  std::vector<std::string> doubled;
  for (const std::string& packet : packets) doubled.insert(doubled.end(), 2, packet);
  const ReadTurns twice = ReadPackets(doubled);
  ExpectSameFrames(twice, plain);
  ASSERT_EQ(twice.remarks.size(), 1U);
  EXPECT_EQ(twice.Number(RemarkKind::kPacketsDoubled), packets.size());
  EXPECT_TRUE(twice.remarks[0].place.ends_with(": packet 1"));
  // As on a line that brings the copies later.
  doubled = packets;
  for (std::size_t i = 0; i + 20 < packets.size(); i += 3) {
    doubled.insert(doubled.begin() + static_cast<std::ptrdiff_t>(i + i / 3 + 15), packets[i]);
  }
  ExpectSameFrames(ReadPackets(doubled), plain);
}

TEST_P(OrderedPackets, ThatAreExchangedComeIntoTheirOrder) {
  auto packets = TwoTurns(GetParam());
  const ReadTurns plain = ReadPackets(packets);
  for (std::size_t i = 5; i + 9 < packets.size(); i += 11)
    std::swap(packets[i], packets[i + i % 9]);
  const ReadTurns read = ReadPackets(packets);
  ExpectSameFrames(read, plain);
  ASSERT_EQ(read.remarks.size(), 1U);
  EXPECT_GT(read.Number(RemarkKind::kPacketsReordered), 0U);
}

TEST_P(OrderedPackets, ThatComeTooLateAreLeftOutAndCounted) {
  auto packets = TwoTurns(GetParam());
  ASSERT_GT(packets.size(), 110U);
  const std::string late = packets[20];
  packets.erase(packets.begin() + 20);
  const ReadTurns without = ReadPackets(packets);
  EXPECT_EQ(without.Number(RemarkKind::kPacketsLost), 1U);
  packets.insert(packets.begin() + 100, late);
  const ReadTurns read = ReadPackets(packets);
  ExpectSameFrames(read, without);
  EXPECT_EQ(read.Number(RemarkKind::kPacketsLate), 1U);
  EXPECT_EQ(read.Number(RemarkKind::kPacketsLost), 0U);
}

TEST_P(OrderedPackets, ThatAreMissingAreCounted) {
  auto packets = TwoTurns(GetParam());
  packets.erase(packets.begin() + 70, packets.begin() + 78);
  packets.erase(packets.begin() + 30);
  const ReadTurns read = ReadPackets(packets);
  ASSERT_EQ(read.remarks.size(), 1U);
  EXPECT_EQ(read.Number(RemarkKind::kPacketsLost), 9U);
  EXPECT_TRUE(read.remarks[0].place.ends_with(": packet 30"));
}

INSTANTIATE_TEST_SUITE_P(Packets,
                         OrderedPackets,
                         testing::Values("vlp16", "hdl32e", "pandar64", "xt32"));

TEST(PacketOrder, BeginsAnewWhereTheClockIsSetBack) {
  auto packets = TwoTurns();
  const ReadTurns plain = ReadPackets(packets);
  // From the middle of the first turn on, by as long as three packets take.
  for (std::size_t i = 40; i < packets.size(); ++i) {
    const auto time_us = LoadAt<std::uint32_t>(packets[i].data() + kTimePlace);
    StoreAt<std::uint32_t>(packets[i].data() + kTimePlace, time_us - 3 * 1327);
  }
  const ReadTurns read = ReadPackets(packets);
  ASSERT_EQ(read.frames.size(), plain.frames.size());
  EXPECT_TRUE(read.remarks.empty());
  for (std::size_t i = 0; i < read.frames.size(); ++i) {
    EXPECT_EQ(read.frames[i].frame.columns, plain.frames[i].frame.columns);
  }
}

TEST(PacketOrder, BeginsAnewWithASensorThatWasStartedAgain) {
  const auto packets = TwoTurns("pandar64");
  const std::size_t num = ReadPackets(packets).frames.size();
  std::vector<std::string> twice(packets.begin() + 100, packets.end());
  twice.insert(twice.end(), packets.begin(), packets.end());
  const ReadTurns read = ReadPackets(twice);
  EXPECT_EQ(read.frames.size(), num + 2);
  EXPECT_EQ(read.Number(RemarkKind::kPacketsLate), 0U);
}

TEST(PacketOrder, MissesNothingWhereASensorIsSilentTurnByTurn) {
  const auto packets = WindowOf(Turns(6));
  EXPECT_EQ(ReadPackets(packets).Number(RemarkKind::kPacketsLost), 0U);
  // Packets are missing in the middle of what is sent.
  auto gappy = packets;
  std::size_t num_lost = 0;
  for (std::size_t i = 0; i < packets.size(); i += 23) {
    const auto azimuth = LoadAt<std::uint16_t>(packets[i].data() + kAzimuthPlace);
    if (azimuth < 14'000 || azimuth > 22'000) continue;
    gappy.erase(gappy.begin() + static_cast<std::ptrdiff_t>(i - num_lost));
    ++num_lost;
  }
  ASSERT_GT(num_lost, 2U);
  EXPECT_EQ(ReadPackets(gappy).Number(RemarkKind::kPacketsLost), num_lost);
}

/// Whether a packet is kept, by its number.
using IsKept = std::function<bool(std::size_t)>;

/// Of what others write on slow disks, in sampled recordings, or while something else is done.
std::vector<IsKept> Losses() {
  std::vector<IsKept> losses = {[](std::size_t /*packet*/) { return true; },
                                [](std::size_t packet) { return packet < 40 || packet >= 100; }};
  for (const std::size_t each : {2U, 3U, 4U, 10U, 30U}) {
    losses.emplace_back([each](std::size_t packet) { return packet % each == 0; });
  }
  for (const std::size_t each : {3U, 11U, 37U}) {
    losses.emplace_back([each](std::size_t packet) { return packet % each != 1; });
  }
  for (const std::size_t each : {12U, 25U, 75U}) {
    losses.emplace_back([each](std::size_t packet) { return packet % each < 6; });
  }
  for (const std::uint32_t percent : {5U, 50U, 80U}) {
    losses.emplace_back([percent](std::size_t packet) {
      return std::mt19937(static_cast<std::uint32_t>(packet))() % 100 >= percent;
    });
  }
  return losses;
}

/// How many of the packets that are not kept are missing between those that are, and how many are
/// said to be lost.
std::pair<std::size_t, std::size_t> MissingAndLost(const std::string& format,
                                                   const std::vector<std::string>& packets,
                                                   const IsKept& is_kept) {
  const SpinningDecoder decoder(*FindSpinningModel(format));
  PacketOrder order;
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < packets.size(); ++i) {
    if (!is_kept(i)) continue;
    kept.push_back(i);
    order.Add({.bytes = {packets[i].begin(), packets[i].end()},
               .places = {},
               .number = i,
               .captured_ns = static_cast<std::int64_t>(i) * 1'000'000},
              decoder.MarkOf(packets[i]));
    while (order.Next()) continue;
  }
  order.End();
  return {kept.back() - kept.front() + 1 - kept.size(), order.lost().number};
}

// Of wide gaps it is only known later how many are missing.
TEST(PacketOrder, TellsTheFirstLossWhateverItsWidth) {
  for (const auto& [format, sensor] :
       {std::pair("vlp16", "vlp16"), {"vlp16", "vlp16_20hz"}, {"hdl32e", "hdl32e"}}) {
    const auto packets = Turns(12, format, sensor);
    const SpinningDecoder decoder(*FindSpinningModel(format));
    for (const auto& [first, second] :
         {std::pair<std::size_t, std::size_t>{40, 1}, {1, 40}, {40, 40}, {1, 1}, {0, 40}}) {
      PacketOrder order;
      for (std::size_t i = 0; i < packets.size(); ++i) {
        const bool is_lost = (i >= 100 && i < 100 + first) || (i >= 300 && i < 300 + second);
        if (is_lost) continue;
        order.Add({.bytes = {packets[i].begin(), packets[i].end()},
                   .places = {},
                   .number = i,
                   .captured_ns = static_cast<std::int64_t>(i) * 1'000'000},
                  decoder.MarkOf(packets[i]));
        while (order.Next()) continue;
      }
      order.End();
      EXPECT_EQ(order.lost().number, first + second) << sensor;
      EXPECT_EQ(order.lost().first, first > 0 ? 100 + first : 300 + second) << sensor;
    }
  }
}

TEST(PacketOrder, CountsLossesThatAreRegularAndThoseThatAreNot) {
  for (const auto& [format, sensor] : {std::pair("vlp16", "vlp16"),
                                       {"vlp16", "vlp16_20hz"},
                                       {"vlp16-dual", "vlp16"},
                                       {"hdl32e", "hdl32e"},
                                       {"vlp32c", "vlp32c"}}) {
    const auto packets = Turns(5, format, sensor);
    for (std::size_t i = 0; const IsKept& is_kept : Losses()) {
      const auto [missing, lost] = MissingAndLost(format, packets, is_kept);
      EXPECT_EQ(lost, missing) << sensor << ", " << i;
      ++i;
    }
  }
}

// A few packets do not tell any window: what is missing between them is lost.
TEST(PacketOrder, CountsLossesBetweenAFewPackets) {
  for (const auto& [format, sensor] : {std::pair("vlp16", "vlp16"),
                                       {"vlp16-dual", "vlp16"},
                                       {"hdl32e", "hdl32e"},
                                       {"vlp32c", "vlp32c"},
                                       {"pandar64", "pandar64"},
                                       {"xt32", "xt32"}}) {
    const auto packets = Turns(5, format, sensor);
    for (const std::size_t num : {3U, 5U, 12U, 30U}) {
      for (std::size_t i = 0; const IsKept& is_kept : Losses()) {
        std::size_t num_kept = 0;
        const IsKept is_one = [&](std::size_t packet) {
          return packet >= 27 && num_kept < num && is_kept(packet) && ++num_kept > 0;
        };
        const auto [missing, lost] = MissingAndLost(format, packets, is_one);
        EXPECT_EQ(lost, missing) << sensor << ", " << num << " packets, " << i;
        ++i;
      }
    }
  }
}

// Windows of real sensors begin and end within packets. How many packets are missing is only known
// where one of those is there.
TEST(PacketOrder, CountsLossesBesideAWindowOfTheSensor) {
  for (const std::string format : {"hdl32e", "vlp32c"}) {
    for (const std::array<double, 2> window_deg : {std::array{300.0, 60.0}, {10.0, 160.0}}) {
      ScanSpec scan = ReadSensor(format);
      std::get<SpinningSpec>(scan.pattern).azimuth_window_deg = window_deg;
      const auto packets = Turns(12, format.c_str(), scan);
      const auto losses = Losses();
      for (const std::size_t loss : {0U, 1U, 2U, 7U, 8U, 9U, 13U}) {
        const auto [missing, lost] = MissingAndLost(format, packets, losses[loss]);
        EXPECT_EQ(lost, missing) << format << ", " << window_deg[0] << ", " << loss;
      }
    }
  }
}

// That of the VLP-32C is silent over half of the turn.
TEST(PacketOrder, CountsLossesInRealCaptures) {
  const std::filesystem::path data = RAILCAST_SHARED_DATA_DIR;
  for (const auto& [format, name] : {std::pair("vlp32c", "lidar_packets_nebula/vlp32c_single.pcap"),
                                     {"vlp16-dual", "lidar_packets_nebula/vlp16_dual.pcap"},
                                     {"hdl32e", "lidar_velodyne_more/hdl32e.pcap"}}) {
    if (!exists(data / name)) GTEST_SKIP() << data / name << " is not there";
    PcapReader reader(data / name);
    std::vector<std::string> packets;
    while (const auto datagram = reader.Next()) {
      packets.emplace_back(datagram->payload.begin(), datagram->payload.end());
    }
    for (std::size_t i = 0; const IsKept& is_kept : Losses()) {
      const auto [missing, lost] = MissingAndLost(format, packets, is_kept);
      // Where 13 or 77 packets are left of 379, they do not tell the window to the packet.
      const bool is_told = format != std::string("vlp32c") || (i != 6 && i != 15);
      EXPECT_TRUE(lost == missing || (!is_told && 20 * lost > 19 * missing))
          << name << ", " << i << ": " << lost << " of " << missing;
      ++i;
    }
  }
}

TEST(PacketOrder, TakesNoRandomLossesForAWindow) {
  const auto packets = Turns(20);
  std::mt19937 random(5);
  std::vector<std::string> kept;
  for (const std::string& packet : packets) {
    const bool is_end = kept.empty() || &packet == &packets.back();
    if (is_end || random() % 12 != 0) kept.push_back(packet);
  }
  const ReadTurns read = ReadPackets(kept);
  EXPECT_EQ(read.Number(RemarkKind::kPacketsLost), packets.size() - kept.size());
}

TEST(PacketOrder, CountsLossesAfterAPacketWithADamagedAzimuth) {
  auto packets = TwoTurns();
  StoreAt<std::uint16_t>(packets[20].data() + kAzimuthPlace,
                         LoadAt<std::uint16_t>(packets[20].data() + kAzimuthPlace) - 5000);
  packets.erase(packets.begin() + 50, packets.begin() + 60);
  EXPECT_EQ(ReadPackets(packets).Number(RemarkKind::kPacketsLost), 10U);
}

TEST(PacketOrder, PutsAPacketInOrderThatIsLateByNearlyATurn) {
  auto packets = Turns(4, "vlp16", "vlp16_20hz");
  const ReadTurns plain = ReadPackets(packets);
  std::rotate(packets.begin() + 50, packets.begin() + 51, packets.begin() + 85);
  const ReadTurns read = ReadPackets(packets);
  ExpectSameFrames(read, plain);
  ASSERT_EQ(read.remarks.size(), 1U);
  EXPECT_EQ(read.Number(RemarkKind::kPacketsReordered), 1U);
}

TEST(PacketOrder, KnowsCopiesOfWhatItHasReturned) {
  const auto packets = TwoTurns();
  const ReadTurns plain = ReadPackets(packets);
  for (const std::ptrdiff_t later : {63, 64, 65, 70, 74}) {
    auto copied = packets;
    copied.insert(copied.begin() + 20 + later + 1, packets[20]);
    const ReadTurns read = ReadPackets(copied);
    ExpectSameFrames(read, plain);
    EXPECT_EQ(read.remarks.size(), 1U) << later;
    EXPECT_EQ(read.Number(RemarkKind::kPacketsDoubled), 1U) << later;
  }
}

TEST(PacketOrder, GoesByTheTimesWhereAllNumbersAre0) {
  auto packets = TwoTurns("xt32");
  for (std::string& packet : packets) {
    StoreAt<std::uint32_t>(packet.data() + Xt32Model().sequence_place, 0);
  }
  const ReadTurns plain = ReadPackets(packets);
  EXPECT_TRUE(plain.remarks.empty());
  std::swap(packets[30], packets[33]);
  const ReadTurns read = ReadPackets(packets);
  ExpectSameFrames(read, plain);
  EXPECT_EQ(read.Number(RemarkKind::kPacketsReordered), 3U);
  packets.erase(packets.begin() + 60, packets.begin() + 64);
  EXPECT_EQ(ReadPackets(packets).Number(RemarkKind::kPacketsLost), 4U);
}

TEST(PacketOrder, PutsPacketsWithoutNumbersBehindThoseBefore) {
  PacketOrder order;
  std::string got;
  for (const char packet : std::string("x01y3")) {
    const bool has_number = packet < 'a';
    order.Add({.bytes = {packet}, .places = {{0, 0}}}, {.number = has_number ? packet - '0' : 0,
                                                        .has_number = has_number,
                                                        .is_counted = true,
                                                        .time_ns = packet});
  }
  order.End();
  while (const auto packet = order.Next()) got += packet->bytes[0];
  EXPECT_EQ(got, "x01y3");
  EXPECT_EQ(order.lost().number, 0U);
}

TEST(SpinningDecoder, LeavesOutBlocksOfZerosAndCountsThem) {
  auto packets = TwoTurns();
  const ReadTurns plain = ReadPackets(packets);
  for (const std::size_t packet : {3U, 10U, 11U}) {
    std::fill_n(packets[packet].begin() + 4 * kBlockSize, 2 * kBlockSize, '\0');
  }
  // With a flag, too.
  std::fill_n(packets[20].begin() + 2, kBlockSize - 2, '\0');
  const ReadTurns read = ReadPackets(packets);
  ASSERT_EQ(read.frames.size(), plain.frames.size());
  // Each block of a VLP-16 holds two firing cycles.
  EXPECT_EQ(read.frames[0].frame.columns + 2 * 7, plain.frames[0].frame.columns);
  ASSERT_EQ(read.remarks.size(), 1U);
  EXPECT_EQ(read.Number(RemarkKind::kBlocksEmpty), 7U);
  // What follows them keeps its times.
  const Frame& frame = read.frames[0].frame;
  const Frame& whole = plain.frames[0].frame;
  EXPECT_EQ(frame.time_ns[frame.columns - 1], whole.time_ns[whole.columns - 1]);
}

TEST(CaptureRecording, SaysWhyItRefusesAPacketOfItsSensor) {
  auto packets = TwoTurns();
  packets[7][kModelPlace] = '\x77';
  packets[8][kModelPlace] = '\x77';
  packets.emplace_back(512, 'r');  // A report of its position.
  packets.emplace_back(300, 'u');
  packets.emplace_back(1500, 'v');
  const ReadTurns read = ReadPackets(packets);
  ASSERT_EQ(read.remarks.size(), 2U);
  EXPECT_EQ(read.remarks[0].kind, RemarkKind::kPacketsRefused);
  EXPECT_EQ(read.remarks[0].number, 2U);
  EXPECT_EQ(read.remarks[0].detail, "model must be 34, VLP-16 (got 119)");
  EXPECT_TRUE(read.remarks[0].place.ends_with(": packet 7"));
  EXPECT_EQ(read.Number(RemarkKind::kDatagramsUnknown), 2U);
}

TEST(CaptureRecording, LeavesOutAPacketOfAnotherSize) {
  auto packets = TwoTurns();
  packets[40] += "tail";
  const ReadTurns read = ReadPackets(packets);
  ASSERT_EQ(read.remarks.size(), 1U);
  EXPECT_EQ(read.Number(RemarkKind::kPacketsRefused), 1U);
  EXPECT_EQ(read.remarks[0].detail, "must be whole packets of 1206 bytes (got 1210)");
}

// As of a sensor without a time, or one whose driver leaves it out.
TEST(CaptureRecording, TakesPacketsAsTheyComeWhereTheClockStandsStill) {
  auto packets = Turns(3);
  const ReadTurns plain = ReadPackets(packets);
  for (std::string& packet : packets) packet.replace(1200, 4, 4, '\0');
  const ReadTurns read = ReadPackets(packets);
  ASSERT_EQ(read.remarks.size(), 1U);
  EXPECT_EQ(read.remarks[0].kind, RemarkKind::kFieldsLeftOut);
  ASSERT_EQ(read.frames.size(), plain.frames.size());
  for (std::size_t i = 0; i < read.frames.size(); ++i) {
    EXPECT_EQ(read.frames[i].frame.x.size(), plain.frames[i].frame.x.size());
  }
}

TEST(CaptureRecording, LeavesOutPacketsThatDoNotAgreeWithTheirChecksumsOfUdp) {
  const auto packets = TwoTurns();
  const auto num_damaged = [&](const auto& is_wrong) {
    std::vector<CapturedFrame> frames;
    for (const std::string& packet : packets) {
      const std::size_t checksum = is_wrong(frames.size()) ? 1 : 0;
      frames.push_back(
          {EthernetOf(IpOf(packet)).replace(40, 2, Big16(checksum)), 1000 * frames.size()});
    }
    const TemporaryDirectory directory;
    const auto recording = OpenRecording(WriteCapture(directory.path() / "a.pcap", frames));
    (void)ReadAll(*recording);
    const auto remarks = recording->info().remarks->List();
    EXPECT_LE(remarks.size(), 1U);
    const auto found = std::ranges::find(remarks, RemarkKind::kPacketsDamaged, &Remark::kind);
    return found == remarks.end() ? 0 : found->number;
  };
  EXPECT_EQ(num_damaged([](std::size_t i) { return i == 0 || i == 40; }), 2U);
  // On the machine that sends them, the network card fills all of them in; one in 65,536 agrees by
  // chance.
  EXPECT_EQ(num_damaged([](std::size_t) { return true; }), 0U);
  EXPECT_EQ(num_damaged([](std::size_t i) { return i != 7; }), 0U);
}

}  // namespace
}  // namespace railcast
