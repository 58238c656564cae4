#include <gtest/gtest.h>
#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/base/input_file.h"
#include "core/base/units.h"
#include "core/extras/packets/spinning/spinning_decoder.h"
#include "core/extras/packets/spinning/spinning_packet.h"
#include "core/io/field_layout.h"
#include "core/io/write_file.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/recording/read_all.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/support/captures.h"
#include "tests/support/decode_packet.h"
#include "tests/support/made_datagrams.h"
#include "tests/support/pcl_reads.h"

namespace railcast {
namespace {

/// A correction file: fields from 20, 140 and 260 deg on, lasers at 10, 9.9, 9.8 ... deg, each 1
/// deg to the left. The shifts are 0.
std::string MadeCorrection() {
  std::string bytes(47'176, '\0');
  const std::string head = {'\xEE', '\xFF', 1, 5, '\x80', 3, 3};
  bytes.replace(0, head.size(), head);
  bytes[15] = 1;
  for (std::uint32_t field = 0; field < 3; ++field) {
    StoreAt<std::uint32_t>(bytes.data() + 16 + 4 * field, (20 + 120 * field) * 25'600);
  }
  for (std::int32_t laser = 0; laser < 128; ++laser) {
    StoreAt<std::int32_t>(bytes.data() + 40 + 4 * laser, 25'600);
    StoreAt<std::int32_t>(bytes.data() + 552 + 4 * laser, 256'000 - 2'560 * laser);
  }
  return bytes;
}

std::size_t ShiftPlace(bool is_elevation, std::size_t laser, std::size_t index) {
  return 1064 + (is_elevation ? 23'040 : 0) + 180 * laser + index;
}

/// A packet of two blocks, 0.1 deg of the rotor apart, of which laser 5 measures 10 m at 50 %, at
/// 2023-03-24 10:00:00.5.
std::vector<char> MadeAt128Packet(double block_deg, std::uint8_t mode = 0x37) {
  std::vector<char> packet(1118, '\0');
  const std::string head = {'\xEE', '\xFF', 4, 3, 0, 0, '\x80', 2, 0, 4};
  std::ranges::copy(head, packet.begin());
  for (std::size_t block = 0; block < 2; ++block) {
    char* const start = packet.data() + 12 + 515 * block;
    const double in_block_deg = block_deg + (mode == 0x39 ? 0.0 : 0.1 * static_cast<double>(block));
    const auto steps = static_cast<std::uint32_t>(std::lround(in_block_deg * 25'600.0));
    StoreAt<std::uint16_t>(start, steps / 256);
    StoreAt<std::uint8_t>(start + 2, steps % 256);
    StoreAt<std::uint16_t>(start + 3 + 4 * 5, 2500);
    start[3 + 4 * 5 + 2] = 50;
  }
  StoreAt<std::uint16_t>(packet.data() + 1064, 200);
  StoreAt<std::uint32_t>(packet.data() + 1066, 500'000);
  packet[1070] = static_cast<char>(mode);
  const std::string date = {123, 3, 24, 10, 0, 0};
  std::ranges::copy(date, packet.begin() + 1072);
  StoreChecksums(ModelNamed("AT128"), packet);
  return packet;
}

std::shared_ptr<const At128Correction> CorrectionOf(const std::string& bytes) {
  return std::make_shared<const At128Correction>(bytes);
}

// A mirror turns the beam by twice its own turn, here by 2 x 45 deg: forward, and 1 deg to the
// left.
TEST(At128Decoder, PlacesAPointByItsBlockAndTheUnitsCorrection) {
  std::string file = MadeCorrection();
  // At 65 deg, halfway between 64 and 66 deg: 0.02 deg.
  file[ShiftPlace(false, 5, 32)] = 4;
  file[ShiftPlace(true, 5, 32)] = -6;
  file[ShiftPlace(true, 5, 33)] = -2;
  SpinningDecoder decoder(At128Model(CorrectionOf(file)));
  std::vector<SensorTurn> turns;
  ASSERT_EQ(DecodePacket(decoder, MadeAt128Packet(65.0), turns), std::nullopt);
  const SensorTurn turn = decoder.TakeUnfinished();
  ASSERT_EQ(turn.points.size(), 2U);
  ASSERT_EQ(turn.num_columns(), 2U);
  const TurnPoint& point = turn.points[0];
  const double azimuth_rad = RadFromDeg(-1.0 + 0.02);
  const double elevation_rad = RadFromDeg(9.5 - 0.04);
  EXPECT_NEAR(point.x, 10.0 * std::cos(elevation_rad) * std::cos(azimuth_rad), 1e-5);
  EXPECT_NEAR(point.y, -10.0 * std::cos(elevation_rad) * std::sin(azimuth_rad), 1e-5);
  EXPECT_NEAR(point.z, 10.0 * std::sin(elevation_rad), 1e-5);
  EXPECT_EQ(point.laser, 5U);
  EXPECT_EQ(point.ring, 122U);
  EXPECT_EQ(point.intensity, 50U);
  // 2023-03-24 10:00:00 UTC; laser 6 of the manual fires 8.24 us after its block begins.
  const std::int64_t packet_ns = 1'679'652'000 * kNsPerS + 500'000'000;
  EXPECT_EQ(turn.stamp_ns, packet_ns - 9'249 - 2 * 41'666);
  EXPECT_EQ(turn.points[1].time_ns, 41'666 + 8'240);
}

TEST(At128Decoder, CountsSecondsWhereThereIsNoDate) {
  std::vector<char> packet = MadeAt128Packet(65.0);
  const std::vector<std::uint8_t> seconds = {0, 0, 0x64, 0x1D, 0x75, 0x20};  // 1679652128.
  std::ranges::copy(seconds, packet.begin() + 1072);
  StoreChecksums(ModelNamed("AT128"), packet);
  SpinningDecoder decoder(At128Model(CorrectionOf(MadeCorrection())));
  std::vector<SensorTurn> turns;
  ASSERT_EQ(DecodePacket(decoder, packet, turns), std::nullopt);
  EXPECT_EQ(decoder.TakeUnfinished().stamp_ns,
            0x641D7520 * kNsPerS + 500'000'000 - 9'249 - 2 * 41'666);
}

TEST(At128Decoder, EndsATurnWhereTheNextMirrorBegins) {
  SpinningDecoder decoder(At128Model(CorrectionOf(MadeCorrection())));
  std::vector<SensorTurn> turns;
  for (const double block_deg : {100.0, 139.95, 200.0, 300.0, 10.0, 30.0}) {
    ASSERT_EQ(DecodePacket(decoder, MadeAt128Packet(block_deg), turns), std::nullopt);
  }
  turns.push_back(decoder.TakeUnfinished());
  std::vector<std::size_t> columns;
  for (const SensorTurn& turn : turns) columns.push_back(turn.num_columns());
  // The second packet has a block on either side; 10 deg belongs to the last mirror.
  EXPECT_EQ(columns, (std::vector<std::size_t>{3, 3, 4, 2}));
}

TEST(At128Decoder, TakesTwoBlocksForOneColumnInDualMode) {
  std::vector<char> packet = MadeAt128Packet(65.0, 0x39);
  StoreAt<std::uint16_t>(packet.data() + 12 + 515 + 3 + 4 * 5, 2000);
  StoreChecksums(ModelNamed("AT128"), packet);
  SpinningDecoder decoder(At128Model(CorrectionOf(MadeCorrection())));
  std::vector<SensorTurn> turns;
  ASSERT_EQ(DecodePacket(decoder, packet, turns), std::nullopt);
  const SensorTurn turn = decoder.TakeUnfinished();
  EXPECT_TRUE(turn.is_dual);
  ASSERT_EQ(turn.points.size(), 2U);
  EXPECT_EQ(turn.num_columns(), 1U);
  EXPECT_FLOAT_EQ(turn.points[1].range_m, 8.0F);
}

TEST(At128Decoder, RefusesWhatIsNoPacketOfIts) {
  SpinningDecoder decoder(At128Model(CorrectionOf(MadeCorrection())));
  std::vector<SensorTurn> turns;
  const auto said = [&](std::size_t place, char byte) {
    std::vector<char> packet = MadeAt128Packet(65.0);
    packet[place] = byte;
    StoreChecksums(ModelNamed("AT128"), packet);
    return DecodePacket(decoder, packet, turns).value_or("");
  };
  EXPECT_EQ(DecodePacket(decoder, {}, turns), "must be 1118 bytes (got 0)");
  EXPECT_EQ(said(7, 3), "must begin as an AT128's, protocol 4.3, 2 blocks of 128");
  EXPECT_EQ(said(9, 0), "distance unit must be > 0 (got 0)");
  EXPECT_EQ(said(1069, 1), "microseconds of the second must be < 1000000 (got 17277216)");
  EXPECT_EQ(said(1070, 0x33), "return mode must be 55, 56 or 57 (got 51)");
  EXPECT_EQ(said(13, '\xFF'), "block 0: azimuth must be <= 35999 (got 65380)");
}

TEST(At128Decoder, RefusesPacketsOfWhichAByteIsWrong) {
  SpinningDecoder decoder(At128Model(CorrectionOf(MadeCorrection())));
  std::vector<SensorTurn> turns;
  const std::vector<char> right = MadeAt128Packet(65.0);
  // In the blocks, their checksum, the tail, its number and its checksum; then in the header and
  // the signature, which no checksum is of.
  for (const std::size_t place : {20, 1041, 1042, 1046, 1079, 1082, 1085}) {
    std::vector<char> packet = right;
    packet[place] ^= 1;
    EXPECT_EQ(DecodePacket(decoder, packet, turns), std::string(kWrongChecksum)) << place;
  }
  for (const std::size_t place : {4, 10, 1086, 1117}) {
    std::vector<char> packet = right;
    packet[place] ^= 1;
    EXPECT_EQ(DecodePacket(decoder, packet, turns), std::nullopt) << place;
  }
}

TEST(At128Correction, SaysWhatIsWrongWithAFile) {
  const auto said = [](std::size_t place, char byte) {
    std::string bytes = MadeCorrection();
    bytes[place] = byte;
    return MessageOf([&] { (void)CorrectionOf(bytes); });
  };
  EXPECT_EQ(MessageOf([] { (void)CorrectionOf("EE"); }), "must be 47176 bytes (got 2)");
  EXPECT_EQ(said(0, 0), "must begin with EE FF (got 65280)");
  EXPECT_EQ(said(3, 3), "minor version must be 5 (got 3)");
  EXPECT_EQ(said(4, 64), "number of lasers must be 128 (got 64)");
  EXPECT_EQ(said(6, 2), "number of fields must be 3 (got 2)");
  EXPECT_EQ(said(15, 0), "resolution must be > 0 (got 0)");
  EXPECT_EQ(said(19, 1), "a field must start before 360 deg (got 675.36)");
  EXPECT_EQ(said(18, 0x10), "fields must start 120 deg apart, to 5 deg (got 43.04)");
  EXPECT_EQ(said(555, 0x7F), "angles of lasers must be within 90 deg (got 83240.72)");
  std::string coarse = MadeCorrection();
  coarse[15] = 4;
  for (std::uint32_t field = 0; field < 3; ++field) {
    StoreAt<std::uint32_t>(coarse.data() + 16 + 4 * field, (20 + 120 * field) * 6'400);
  }
  coarse[ShiftPlace(true, 5, 7)] = 127;
  EXPECT_EQ(MessageOf([&] { (void)CorrectionOf(coarse); }),
            "shifts of lasers must be within 5 deg (got 5.08)");
}

std::filesystem::path At128File(const char* name) {
  return std::filesystem::path(RAILCAST_SHARED_DATA_DIR "/hesai_calibration") / name;
}

/// How far a direction is from the nearest elevation that a laser has at this azimuth, whichever
/// mirror looks there.
double ElevationGap_deg(const At128Correction& correction,
                        double azimuth_deg,
                        double elevation_deg) {
  double gap_deg = 1e9;
  for (std::size_t laser = 0; laser < kAt128Lasers; ++laser) {
    if (std::abs(correction.elevation_deg(laser) - elevation_deg) > 1.5) continue;
    for (const double begin_deg : {80.0, 200.0, 320.0}) {
      const std::size_t field = correction.FieldAt(begin_deg);
      double block_deg = begin_deg;
      // The azimuth grows twice as fast as the block's, but for the shifts.
      for (int i = 0; i < 4; ++i) {
        const double apart_deg = correction.At(block_deg, field, laser).azimuth_deg - azimuth_deg;
        block_deg -= std::remainder(apart_deg, 360.0) / 2.0;
        block_deg -= 360.0 * std::floor(block_deg / 360.0);
      }
      const double seen_deg = correction.At(block_deg, field, laser).elevation_deg;
      gap_deg = std::min(gap_deg, std::abs(seen_deg - elevation_deg));
    }
  }
  return gap_deg;
}

// Lasers are 0.2 deg apart: by chance, one in a hundred points would be as near.
TEST(At128Correction, HasTheElevationsOfARealCloud) {
  const auto file = At128File("PandarAT128.dat");
  const auto cloud_file = At128File("at128_1679653308704927652.pcd");
  if (!exists(file)) GTEST_SKIP() << file << " is not there";
  const auto correction = CorrectionOf(ReadFileWhole(file));
  const auto cloud = PclReads<pcl::PointCloud<pcl::PointXYZ>>(cloud_file);
  ASSERT_EQ(cloud.size(), 10'198U);
  std::size_t num_seen = 0;
  std::size_t num_same = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i, ++num_seen) {
    const auto& point = cloud[i];
    const double horizontal_m = std::hypot(point.x, point.y);
    const double azimuth_deg = DegFromRad(std::atan2(-point.y, point.x));
    const double elevation_deg = DegFromRad(std::atan2(point.z, horizontal_m));
    num_same += ElevationGap_deg(*correction, azimuth_deg, elevation_deg) < 0.001;
  }
  RecordProperty("same", std::to_string(num_same) + " of " + std::to_string(num_seen));
  EXPECT_GT(static_cast<double>(num_same), 0.99 * static_cast<double>(num_seen));
}

std::filesystem::path WriteAt128Capture(const std::filesystem::path& folder) {
  Datagrams datagrams;
  for (const double block_deg : {100.0, 100.2, 200.0}) {
    AddDatagram(MadeAt128Packet(block_deg), datagrams);
  }
  return WriteDatagrams(folder / "out.pcap", datagrams, 2368, 2368);
}

TEST(At128Recording, TakesTheCorrectionFileBesideTheCapture) {
  const TemporaryDirectory folder;
  const auto capture = WriteAt128Capture(folder.path());
  const std::string missing = MessageOf([&] { (void)OpenRecording(capture); });
  EXPECT_TRUE(
      missing.ends_with("(got packets of an AT128, whose correction file must be beside the "
                        "capture, with its name and .dat)"))
      << missing;
  const auto correction = folder.path() / "out.dat";
  WriteFileWhole(correction, "EE");
  EXPECT_EQ(MessageOf([&] { (void)OpenRecording(capture); }),
            correction.string() + ": must be 47176 bytes (got 2)");
  std::filesystem::copy_file(RAILCAST_SOURCE_DIR "/scenarios/sensors/at128.dat", correction,
                             std::filesystem::copy_options::overwrite_existing);
  const auto recording = OpenRecording(capture);
  EXPECT_EQ(recording->info().kind, "capture of AT128");
  const auto frames = ReadAll(*recording);
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[0].frame.rows, 128U);
  EXPECT_EQ(frames[0].frame.columns, 4U);
  EXPECT_EQ(frames[1].frame.columns, 2U);
}

}  // namespace
}  // namespace railcast
