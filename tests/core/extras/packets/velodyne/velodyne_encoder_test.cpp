#include "core/extras/packets/spinning/spinning_encoder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <vector>

#include "core/extras/packets/velodyne/velodyne_packet.h"
#include "tests/core/extras/packets/velodyne/made_scan.h"
#include "tests/support/made_datagrams.h"
#include "tests/support/sensor_file.h"

namespace railcast {
namespace {

constexpr float kNotMeasured = std::numeric_limits<float>::quiet_NaN();

std::uint16_t AzimuthIn(std::span<const char> packet, std::size_t block) {
  return LoadAt<std::uint16_t>(packet.data() + block * kBlockSize + kAzimuthPlace);
}
std::uint16_t DistanceAt(std::span<const char> packet, std::size_t block, std::size_t place) {
  return LoadAt<std::uint16_t>(packet.data() + block * kBlockSize + kReturnsPlace +
                               place * kReturnSize);
}
std::uint8_t ReflectivityIn(std::span<const char> packet, std::size_t block, std::size_t place) {
  return LoadAt<std::uint8_t>(packet.data() + block * kBlockSize + kReturnsPlace +
                              place * kReturnSize + 2);
}
std::uint32_t TimeIn(std::span<const char> packet) {
  return LoadAt<std::uint32_t>(packet.data() + kTimePlace);
}

TEST(VelodyneEncoder, CompletesWithTheNextFrameWhatAFrameLeaves) {
  const MadeScan scan(ReadSensor("vlp16"));
  const auto encoder =
      MakeSpinningEncoder(*FindSpinningModel("vlp16"), scan.spec(), ReturnMode::kStrongest);
  std::vector<std::size_t> num_packets;
  Datagrams datagrams;
  for (std::uint32_t i = 0; i < 3; ++i) {
    encoder->Encode(scan.MakeFrame(i), datagrams);
    num_packets.push_back(DataPackets(datagrams).size());
  }
  // A frame of 1808 columns fills 75 1/3 packets of 24 columns.
  EXPECT_THAT(num_packets, testing::ElementsAre(75, 150, 226));
  const auto packets = DataPackets(datagrams);
  // The 76th packet has 8 columns of the first frame, whose last one begins 0.0009 turns before the
  // next frame.
  EXPECT_EQ(AzimuthIn(packets[75], 3), scan.AzimuthUnits(1806));
  EXPECT_EQ(AzimuthIn(packets[75], 4), 0);
  EXPECT_EQ(AzimuthIn(packets[75], 5), scan.AzimuthUnits(2));
}

TEST(VelodyneEncoder, LeavesOutEveryPacketThatHasAPartOfAFrameLeftOut) {
  struct Format {
    std::string name;
    double blocks_per_column;
  };
  // Frames fill 75 1/3, 347 1/6 and 180 5/6 packets.
  for (const auto& [name, blocks_per_column] :
       {Format{"vlp16", 0.5}, Format{"hdl64e", 2.0}, Format{"hdl32e", 1.0}}) {
    const MadeScan scan(ReadSensor(name));
    std::vector<Frame> frames;
    for (std::uint32_t i = 0; i < 9; ++i) frames.push_back(scan.MakeFrame(i));
    const auto blocks = static_cast<std::size_t>(blocks_per_column * frames[0].columns);
    ASSERT_NE(blocks % 12, 0U) << "or no packet would be of two frames";
    const Datagrams all = EncodeAll(name, scan, frames);
    const auto packets = DataPackets(all);
    for (const std::size_t num_left_out : {1U, 2U, 5U}) {
      std::vector<Frame> rest = frames;
      rest.erase(rest.begin() + 2, rest.begin() + 2 + static_cast<std::ptrdiff_t>(num_left_out));
      std::vector<std::string> expected;
      for (std::size_t i = 0; i < packets.size(); ++i) {
        const bool is_before = 12 * (i + 1) <= 2 * blocks;
        const bool is_behind = 12 * i >= (2 + num_left_out) * blocks;
        if (is_before || is_behind) expected.emplace_back(packets[i].begin(), packets[i].end());
      }
      const std::vector<std::string> got = DataTexts(EncodeAll(name, scan, rest));
      EXPECT_EQ(got.size(), expected.size()) << name << " without " << num_left_out;
      EXPECT_TRUE(got == expected) << name << " without " << num_left_out;
    }
  }
}

TEST(VelodyneEncoder, WritesBlocksAsTheManualShowsThem) {
  const MadeScan scan(ReadSensor("vlp16"));
  Frame frame = scan.MakeFrame(0);
  // Laser 2 has elevation -13 deg: row 1. The second half of a block is the next column.
  frame.range_m[1 * 1808 + 6] = 40.0F;
  frame.range_m[1 * 1808 + 7] = 41.25F;
  const Datagrams datagrams = EncodeAll("vlp16", scan, {frame});
  const auto packet = DataPackets(datagrams)[0];
  ASSERT_EQ(packet.size(), 1206U);
  for (std::size_t block = 0; block < 12; ++block) {
    EXPECT_EQ(static_cast<unsigned char>(packet[block * 100]), 0xFF);
    EXPECT_EQ(static_cast<unsigned char>(packet[block * 100 + 1]), 0xEE);
    EXPECT_EQ(AzimuthIn(packet, block),
              std::lround(2.0 * static_cast<double>(block) * 55.296e-6 * 3600.0 * 100.0));
  }
  EXPECT_EQ(TimeIn(packet), 0U);
  EXPECT_EQ(static_cast<unsigned char>(packet[1204]), 0x37);
  EXPECT_EQ(static_cast<unsigned char>(packet[1205]), 0x22);
  EXPECT_EQ(DistanceAt(packet, 3, 2), 20'000);
  EXPECT_EQ(DistanceAt(packet, 3, 18), 20'625);
}

TEST(VelodyneEncoder, PutsTheUpperHalfOfHdl64eIntoBlocksOfTheirOwn) {
  const MadeScan scan(ReadSensor("hdl64e"));
  const Datagrams datagrams = EncodeAll("hdl64e", scan, {scan.MakeFrame(0)});
  const auto packets = DataPackets(datagrams);
  EXPECT_EQ(packets.size(), 2083U / 6);
  for (std::size_t block = 0; block < 12; ++block) {
    const auto flag = LoadAt<std::uint16_t>(packets[1].data() + block * kBlockSize);
    EXPECT_EQ(flag, block % 2 == 0 ? 0xEEFF : 0xDDFF);
    EXPECT_EQ(AzimuthIn(packets[1], block),
              scan.AzimuthUnits(static_cast<std::uint32_t>(6 + block / 2)));
  }
}

/// Returns the distances and reflectivities that a firing with these returns gives.
std::array<int, 4> DualBlocks(std::vector<std::pair<float, float>> returns) {
  const MadeScan scan(ReadSensor("vlp16"));
  const auto num_returns = static_cast<std::uint32_t>(returns.size());
  Frame frame = scan.MakeFrame(0, num_returns);
  // Laser 0 is the lowest row; its second column is set.
  for (std::uint32_t r = 0; r < num_returns; ++r) {
    frame.range_m[num_returns + r] = returns[r].first;
    frame.intensity[num_returns + r] = returns[r].second;
  }
  const Datagrams datagrams = EncodeAll("vlp16-dual", scan, {frame});
  const auto packet = DataPackets(datagrams)[0];
  EXPECT_EQ(static_cast<unsigned char>(packet[kModePlace]), 0x39);
  EXPECT_EQ(AzimuthIn(packet, 0), AzimuthIn(packet, 1));
  EXPECT_NE(AzimuthIn(packet, 1), AzimuthIn(packet, 2));
  return {DistanceAt(packet, 0, 16), ReflectivityIn(packet, 0, 16), DistanceAt(packet, 1, 16),
          ReflectivityIn(packet, 1, 16)};
}

TEST(VelodyneEncoder, PutsTheLastReturnBeforeTheStrongest) {
  EXPECT_THAT(DualBlocks({{10.0F, 0.5F}, {20.0F, 0.2F}}),
              testing::ElementsAre(10000, 20, 5000, 50));
}

TEST(VelodyneEncoder, PutsTheSecondStrongestWhereTheStrongestIsTheLast) {
  EXPECT_THAT(DualBlocks({{20.0F, 0.5F}, {10.0F, 0.2F}}),
              testing::ElementsAre(10000, 50, 5000, 20));
}

TEST(VelodyneEncoder, RepeatsTheOnlyReturn) {
  EXPECT_THAT(DualBlocks({{20.0F, 0.5F}, {kNotMeasured, kNotMeasured}}),
              testing::ElementsAre(10000, 50, 10000, 50));
  EXPECT_THAT(DualBlocks({{20.0F, 0.5F}}), testing::ElementsAre(10000, 50, 10000, 50));
  // The last return lies beyond the format's range.
  EXPECT_THAT(DualBlocks({{20.0F, 0.5F}, {131.08F, 0.2F}}),
              testing::ElementsAre(10000, 50, 10000, 50));
  EXPECT_THAT(DualBlocks({{131.08F, 0.5F}, {20.0F, 0.2F}}),
              testing::ElementsAre(10000, 20, 10000, 20));
  EXPECT_THAT(DualBlocks({{kNotMeasured, kNotMeasured}, {kNotMeasured, kNotMeasured}}),
              testing::ElementsAre(0, 0, 0, 0));
}

TEST(VelodyneEncoder, RefusesDistancesThatTheFormatCannotSay) {
  const MadeScan scan(ReadSensor("vlp32c"));
  Frame frame = scan.MakeFrame(0);
  // VLP-32C counts units of 4 mm, of which 65535 are 262.14 m. Laser 0 is the lowest row.
  const std::vector<float> ranges_m = {262.14F, 262.143F, 0.002F, 0.0F, -1.0F, kNotMeasured, 1e30F};
  std::copy(ranges_m.begin(), ranges_m.end(), frame.range_m.begin());
  const Datagrams datagrams = EncodeAll("vlp32c", scan, {frame});
  std::vector<int> distances;
  for (std::size_t i = 0; i < ranges_m.size(); ++i) {
    distances.push_back(DistanceAt(DataPackets(datagrams)[0], i, 0));
  }
  EXPECT_THAT(distances, testing::ElementsAre(65535, 0, 1, 0, 0, 0, 0));
  EXPECT_EQ(ReflectivityIn(DataPackets(datagrams)[0], 1, 0), 0);
}

TEST(VelodyneEncoder, KeepsAzimuthsWithinATurn) {
  for (const double start_azimuth_deg : {-360.0, -30.0, 0.0, 359.996, 360.0}) {
    ScanSpec spec = ReadSensor("vlp16");
    std::get<SpinningSpec>(spec.pattern).start_azimuth_deg = start_azimuth_deg;
    const MadeScan scan(spec);
    const Datagrams datagrams = EncodeAll("vlp16", scan, {scan.MakeFrame(0)});
    EXPECT_EQ(AzimuthIn(DataPackets(datagrams)[0], 0), start_azimuth_deg == -30.0 ? 33'000 : 0);
    for (const auto& packet : DataPackets(datagrams)) {
      for (std::size_t block = 0; block < 12; ++block) EXPECT_LT(AzimuthIn(packet, block), 36'000);
    }
  }
}

TEST(VelodyneEncoder, CountsMicrosecondsPastTheHourWithoutDrift) {
  const MadeScan scan(ReadSensor("vlp16_20hz"));
  Frame frame = scan.MakeFrame(0);
  constexpr std::int64_t kDay_ns = 86'400'000'000'000;
  // Frames at arbitrary times and around the ends of an hour and of a day.
  for (const std::int64_t stamp_ns :
       {std::int64_t{0}, 3'599'999'999'000L, 3'599'999'999'999L, 3'600'000'000'000L,
        kDay_ns - 47'000'000, kDay_ns - 1, kDay_ns, 7 * kDay_ns + 123'456'789}) {
    frame.stamp_ns = stamp_ns;
    const Datagrams datagrams = EncodeAll("vlp16", scan, {frame});
    const auto packets = DataPackets(datagrams);
    for (std::size_t i = 0; i < packets.size(); ++i) {
      const std::int64_t first_ns = stamp_ns + frame.time_ns[24 * i];  // Row 0 fires first.
      EXPECT_EQ(TimeIn(packets[i]), first_ns / 1000 % 3'600'000'000) << stamp_ns;
    }
  }
}

TEST(VelodyneEncoder, StampsAWholeDayOfFrames) {
  ScanSpec spec = ReadSensor("vlp16");
  spec.rate_hz = 10.0;
  const MadeScan scan(spec);
  const ScanPattern pattern = BuildScanPattern(spec);
  const auto encoder =
      MakeSpinningEncoder(*FindSpinningModel("vlp16"), spec, ReturnMode::kStrongest);
  Frame frame = scan.MakeFrame(0);
  Datagrams datagrams;
  // Every 1001st frame of 24 h.
  for (std::uint32_t index = 0; index < 864'000; index += 1001) {
    frame.stamp_ns = pattern.StampNs(index);
    datagrams.Clear();
    MakeSpinningEncoder(*FindSpinningModel("vlp16"), spec, ReturnMode::kStrongest)
        ->Encode(frame, datagrams);
    ASSERT_EQ(TimeIn(DataPackets(datagrams)[0]), index * 100'000LL % 3'600'000'000) << index;
  }
}

TEST(VelodyneEncoder, LetsAPacketLeaveAtItsLastFiring) {
  const MadeScan scan(ReadSensor("vlp16"));
  const std::vector<Frame> frames = {scan.MakeFrame(0), scan.MakeFrame(1)};
  const Datagrams datagrams = EncodeAll("vlp16", scan, frames);
  EXPECT_TRUE(std::ranges::is_sorted(datagrams.items, {}, &Datagrams::Item::due_ns));
  std::vector<std::int64_t> due_ns;
  for (const auto& item : datagrams.items) {
    if (item.port == DatagramPort::kData) due_ns.push_back(item.due_ns);
  }
  // The highest row fires last; the 76th packet ends with 16 columns of the second frame.
  EXPECT_EQ(due_ns[0], frames[0].time_ns[15 * 1808 + 23]);
  EXPECT_EQ(due_ns[75], 100'000'000 + frames[1].time_ns[15 * 1808 + 15]);
}

TEST(VelodyneEncoder, SaysItsTimeOnceASecond) {
  const MadeScan scan(ReadSensor("vlp16"));
  Frame frame = scan.MakeFrame(0);
  const auto encoder =
      MakeSpinningEncoder(*FindSpinningModel("vlp16"), scan.spec(), ReturnMode::kStrongest);
  Datagrams datagrams;
  for (std::int64_t index = 5; index < 26; ++index) {
    frame.stamp_ns = index * 100'000'000;
    encoder->Encode(frame, datagrams);
  }
  std::vector<std::int64_t> due_ns;
  for (const auto& item : datagrams.items) {
    if (item.port == DatagramPort::kPosition) due_ns.push_back(item.due_ns);
  }
  EXPECT_THAT(due_ns, testing::ElementsAre(1'000'000'000, 2'000'000'000));
  EXPECT_TRUE(std::ranges::is_sorted(datagrams.items, {}, &Datagrams::Item::due_ns));
}

TEST(Reflectivity, IsPercentForDiffuseSurfacesAndLogarithmicForRetroreflectors) {
  EXPECT_EQ(ReflectivityByte(kNotMeasured), 0);
  EXPECT_EQ(ReflectivityByte(-0.1F), 0);
  EXPECT_EQ(ReflectivityByte(0.0F), 0);
  EXPECT_EQ(ReflectivityByte(0.104F), 10);
  EXPECT_EQ(ReflectivityByte(1.0F), 100);
  EXPECT_EQ(ReflectivityByte(1.001F), 101);
  EXPECT_EQ(ReflectivityByte(10.0F), 101 + 51);
  EXPECT_EQ(ReflectivityByte(100.0F), 101 + 102);
  EXPECT_EQ(ReflectivityByte(999.0F), 254);
  EXPECT_EQ(ReflectivityByte(1000.0F), 255);
  EXPECT_EQ(ReflectivityByte(std::numeric_limits<float>::infinity()), 255);
}

TEST(Reflectivity, NeverFallsAsTheIntensityRises) {
  std::uint8_t last = 0;
  for (float intensity = 0.001F; intensity < 2000.0F; intensity *= 1.01F) {
    EXPECT_GE(ReflectivityByte(intensity), last);
    last = ReflectivityByte(intensity);
  }
}

}  // namespace
}  // namespace railcast
