#include "core/extras/packets/ouster/ouster_packet.h"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/core/extras/packets/ouster/shared_captures.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/support/ouster_metadata_text.h"
#include "tests/support/run_command.h"

namespace railcast {
namespace {

/// The MD5 hash of numbers, by the program of the system.
template <typename Number>
std::string Md5Of(const std::vector<Number>& numbers) {
  const TemporaryDirectory folder;
  const auto file = folder.path() / "numbers";
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(numbers.data()),
             static_cast<std::streamsize>(numbers.size() * sizeof(Number)));
  return RunCommand("md5sum " + file.string()).said.substr(0, 32);
}

/// What the maker's own decoder makes of a capture: hashes of its fields, in rows of columns.
TEST(OusterPacket, OfARealCaptureHasTheFieldsThatTheMakersDecoderFinds) {
  const auto file = OusterCapture::Path("lidar_ouster/OS-2-128-U1_v2.3.0_1024x10_digest.json");
  if (!kOs2Capture.is_there() || !exists(file)) GTEST_SKIP() << file << " is not there";
  const OusterLayout layout(kOs2Capture.metadata());
  constexpr std::size_t kColumns = 1024;
  const std::size_t num_slots = kColumns * layout.num_pixels();
  std::vector<std::uint64_t> times(kColumns);
  std::vector<std::uint16_t> measurements(kColumns);
  std::vector<std::uint32_t> ranges(num_slots);
  std::vector<std::uint16_t> signals(num_slots);
  std::vector<std::uint8_t> reflectivities(num_slots);
  std::vector<std::uint16_t> near_irs(num_slots);
  std::vector<std::uint8_t> flags(num_slots);
  for (const std::vector<char>& packet : LidarPacketsOf(kOs2Capture)) {
    EXPECT_EQ(layout.HeaderOf(packet).frame_id, 1259U);
    for (std::size_t i = 0; i < layout.num_columns(); ++i) {
      const OusterColumn column = layout.ColumnOf(packet, i);
      ASSERT_TRUE(column.is_valid);
      times.at(column.measurement_id) = column.time_ns;
      measurements[column.measurement_id] = column.measurement_id;
      for (std::size_t row = 0; row < layout.num_pixels(); ++row) {
        const OusterPixel pixel = layout.PixelOf(packet, i, row);
        const std::size_t slot = row * kColumns + column.measurement_id;
        ranges[slot] = pixel.returns[0].range_mm;
        signals[slot] = pixel.returns[0].signal;
        reflectivities[slot] = static_cast<std::uint8_t>(pixel.returns[0].reflectivity);
        flags[slot] = pixel.returns[0].flags;
        near_irs[slot] = pixel.near_ir;
      }
    }
  }
  const auto digest = nlohmann::json::parse(std::ifstream(file));
  const auto& scan = digest["scans"][0];
  EXPECT_EQ(scan["FRAME_ID"], "1259");
  EXPECT_EQ(Md5Of(times), scan["TIMESTAMP"]);
  EXPECT_EQ(Md5Of(measurements), scan["MEASUREMENT_ID"]);
  EXPECT_EQ(Md5Of(ranges), scan["RANGE"]);
  EXPECT_EQ(Md5Of(signals), scan["SIGNAL"]);
  EXPECT_EQ(Md5Of(reflectivities), scan["REFLECTIVITY"]);
  EXPECT_EQ(Md5Of(near_irs), scan["NEAR_IR"]);
  EXPECT_EQ(Md5Of(flags), digest["packet_hash"]["FLAGS"]) << "all are 0";
}

class RealOusterCapture : public testing::TestWithParam<OusterCapture> {};

TEST_P(RealOusterCapture, HoldsPacketsOfItsMetadata) {
  if (!GetParam().is_there()) GTEST_SKIP() << GetParam().pcap << " is not there";
  const OusterMetadata metadata = GetParam().metadata();
  EXPECT_EQ(metadata.profile, GetParam().profile);
  const auto packets = LidarPacketsOf(GetParam());
  EXPECT_EQ(packets.size(), GetParam().num_packets);
  const OusterLayout layout(metadata);
  for (const std::vector<char>& packet : packets) {
    const OusterHeader header = layout.HeaderOf(packet);
    if (layout.is_legacy()) continue;
    EXPECT_EQ(header.packet_type, 1);
    EXPECT_EQ(header.serial_number, metadata.serial_number);
    EXPECT_EQ(header.initialization_id, metadata.initialization_id);
  }
}

/// A packet in which all bits of railcast's fields are 1.
std::vector<char> OwnBits(const OusterLayout& layout) {
  std::vector<char> bits(layout.packet_size());
  layout.Store({.packet_type = 0xFFFF,
                .frame_id = 0xFFFFFFFF,
                .initialization_id = 0xFFFFFFFF,
                .serial_number = ~std::uint64_t{0},
                .alert_flags = 0xFF,
                .shutdown_countdown_s = 0xFF,
                .shot_limiting_countdown_s = 0xFF,
                .thermal_shutdown = 0xFF,
                .shot_limiting = 0xFF},
               bits);
  const OusterReturn full{0xFFFFFFFF, 0xFF, 0xFFFF, 0xFFFF};
  for (std::size_t i = 0; i < layout.num_columns(); ++i) {
    layout.Store({~std::uint64_t{0}, 0xFFFF, true}, i, 0xFFFFFFFF, 0xFFFFFFFF, bits);
    for (std::size_t row = 0; row < layout.num_pixels(); ++row) {
      layout.Store(OusterPixel{{full, full}, 0xFFFF}, i, row, bits);
    }
  }
  return bits;
}

// Firmware 2.0 to 3.2, all profiles, windows, shot limiting.
TEST_P(RealOusterCapture, IsEncodedAgainByteByByteWhereTheFieldsAreOurs) {
  if (!GetParam().is_there()) GTEST_SKIP() << GetParam().pcap << " is not there";
  const OusterMetadata metadata = GetParam().metadata();
  const OusterLayout layout(metadata);
  const std::vector<char> own = OwnBits(layout);
  std::size_t num_foreign_bytes = 0;
  for (const std::vector<char>& packet : LidarPacketsOf(GetParam())) {
    std::vector<char> again(packet.size());
    const OusterHeader header = layout.HeaderOf(packet);
    layout.Store(header, again);
    for (std::size_t i = 0; i < layout.num_columns(); ++i) {
      const OusterColumn column = layout.ColumnOf(packet, i);
      const std::uint32_t ticks = column.measurement_id * (90'112 / metadata.columns_per_frame);
      layout.Store(column, i, header.frame_id, ticks, again);
      for (std::size_t row = 0; row < layout.num_pixels(); ++row) {
        layout.Store(layout.PixelOf(packet, i, row), i, row, again);
      }
    }
    const std::size_t footer = layout.may_have_checksum() ? 8 : 0;
    for (std::size_t i = 0; i < packet.size() - footer; ++i) {
      ASSERT_EQ(again[i], static_cast<char>(packet[i] & own[i])) << "byte " << i;
      num_foreign_bytes += packet[i] != again[i] ? 1 : 0;
    }
    if (!layout.may_have_checksum()) continue;
    EXPECT_TRUE(HasRightChecksum(packet));
    if (!GetParam().is_ours) continue;
    StoreChecksum(again);
    EXPECT_EQ(again, packet) << "as a whole";
  }
  RecordProperty("foreign_bytes", static_cast<int>(num_foreign_bytes));
}

INSTANTIATE_TEST_SUITE_P(OusterPacket,
                         RealOusterCapture,
                         testing::ValuesIn(kOusterCaptures),
                         [](const auto& test) { return "Number" + std::to_string(test.index); });

TEST(OusterPacket, OfARealSensorThatLimitsItsShotsSaysSo) {
  const OusterCapture& capture = kOusterCaptures[7];
  if (!capture.is_there()) GTEST_SKIP() << capture.pcap << " is not there";
  const OusterLayout layout(capture.metadata());
  const OusterHeader header = layout.HeaderOf(LidarPacketsOf(capture).at(0));
  EXPECT_EQ(header.shot_limiting, 1);
  EXPECT_EQ(header.thermal_shutdown, 1);
  EXPECT_EQ(header.shutdown_countdown_s, 5);
}

// The check value of CRC-64/XZ: that of the nine digits.
TEST(OusterChecksum, IsTheCrcOfXz) {
  EXPECT_EQ(OusterChecksum(std::span<const char>("123456789", 9)), 0x995DC9BBDF1939FA);
}

TEST(OusterChecksum, OfAChangedPacketIsWrong) {
  const OusterMetadata metadata = ParseOusterMetadata(MadeOusterMetadataText());
  std::vector<char> packet(OusterPacketSize(metadata), '\3');
  StoreChecksum(packet);
  EXPECT_TRUE(HasRightChecksum(packet));
  packet[40] = '\4';
  EXPECT_FALSE(HasRightChecksum(packet));
}

TEST(OusterImu, OfARealSensorAtRestFeelsGravity) {
  if (!kOs2Capture.is_there()) GTEST_SKIP() << kOs2Capture.pcap << " is not there";
  const auto packets = PayloadsOf(kOs2Capture, kOusterImuPacketSize);
  ASSERT_EQ(packets.size(), 10U);
  for (const std::vector<char>& packet : packets) {
    const std::span<const char, kOusterImuPacketSize> bytes(packet.data(), packet.size());
    const OusterImu imu = ImuOf(bytes);
    EXPECT_NEAR(imu.acceleration_g[2], 1.0, 0.05);
    EXPECT_NEAR(imu.rotation_degps[1], 0.0, 5.0);
    std::array<char, kOusterImuPacketSize> again{};
    StoreImu(imu, again);
    EXPECT_TRUE(std::equal(again.begin(), again.end(), packet.begin()));
  }
}

}  // namespace
}  // namespace railcast
