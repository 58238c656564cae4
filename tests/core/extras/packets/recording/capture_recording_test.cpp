#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/extras/packets/recording/capture_recording.h"
#include "core/extras/packets/recording/capture_sensor.h"
#include "core/extras/packets/spinning/spinning_encoder.h"
#include "core/extras/packets/spinning/spinning_model.h"
#include "core/extras/packets/velodyne/velodyne_packet.h"
#include "railcast/io/recording.h"
#include "tests/core/extras/packets/velodyne/made_scan.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/recording/read_all.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/support/captures.h"
#include "tests/support/faults.h"
#include "tests/support/hesai_bag.h"
#include "tests/support/made_datagrams.h"
#include "tests/support/sensor_file.h"

namespace railcast {
namespace {

class CapturedFormat : public testing::TestWithParam<const char*> {};

TEST_P(CapturedFormat, HasASlotForEveryFiringOfTheFrames) {
  const std::string_view format = GetParam();
  const MadeScan scan(ReadSensor(std::string(SensorOf(format))));
  const std::uint32_t returns = format == "vlp16-dual" ? 2 : 1;
  std::vector<Frame> truth;
  for (std::uint32_t i = 0; i < 3; ++i) truth.push_back(scan.MakeFrame(i, returns));
  const TemporaryDirectory directory;
  const auto file = directory.path() / "a.pcap";
  WriteDatagrams(file, EncodeAll(format, scan, truth));
  const auto frames = ReadAll(file);
  ASSERT_EQ(frames.size(), 3U);
  // The greatest range that a packet can hold.
  const double max_m = 65535.5 * 1e-3 * FindSpinningModel(format)->unit_mm;
  const auto is_sent = [&](float range_m) { return static_cast<double>(range_m) < max_m; };
  // The last packet would end with the beginning of a further frame, so the last frame is cut
  // short.
  for (std::size_t f = 0; f < 2; ++f) {
    const Frame& frame = frames[f].frame;
    EXPECT_TRUE(frames[f].is_grid);
    EXPECT_TRUE(frames[f].Has("time_ns"));
    EXPECT_FALSE(frames[f].Has("outcome"));
    EXPECT_EQ(frame.index, f);
    ASSERT_EQ(frame.rows, truth[f].rows);
    ASSERT_EQ(frame.columns, truth[f].columns);
    ASSERT_EQ(frame.returns, returns);
    for (std::size_t i = 0; i < frame.num_slots(); i += returns) {
      ASSERT_EQ(frame.ring[i], truth[f].ring[i]);
      ASSERT_EQ(frame.column[i], truth[f].column[i]);
      // Firings with no, one or two returns keep that number, in whatever order the returns are.
      std::size_t num = 0;
      for (std::size_t r = i; r < i + returns; ++r) num += is_sent(truth[f].range_m[r]);
      ASSERT_EQ(frame.return_count[i], num);
      if (returns > 1) continue;
      ASSERT_EQ(std::isnan(frame.x[i]), !is_sent(truth[f].range_m[i]));
      ASSERT_EQ(std::isnan(frame.intensity[i]), !is_sent(truth[f].range_m[i]));
      if (std::isnan(frame.x[i])) continue;
      ASSERT_NEAR(frame.range_m[i], truth[f].range_m[i], 0.0021);
      ASSERT_EQ(ReflectivityByte(frame.intensity[i]), ReflectivityByte(truth[f].intensity[i]));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(CaptureRecording,
                         CapturedFormat,
                         testing::Values("vlp16", "vlp16-dual", "hdl32e", "vlp32c", "vls128"),
                         [](const auto& test) {
                           std::string name = test.param;
                           std::erase(name, '-');
                           return name;
                         });

TEST(Reflectivity, OfAnIntensityIsTheByteItCameFrom) {
  for (int byte = 0; byte < 256; ++byte) {
    EXPECT_EQ(ReflectivityByte(IntensityOfByte(static_cast<std::uint8_t>(byte))), byte);
  }
}

// It is what rounds to it: less than half a percent.
TEST(Reflectivity, OfByte0IsAQuarterPercentInCapturesOfAllKinds) {
  for (const IntensityBytes bytes : {IntensityBytes::kVelodyne, IntensityBytes::kPercent}) {
    const SensorTurn turn{.points = {{.x = 5.0F, .range_m = 5.0F},
                                     {.x = 5.0F, .range_m = 5.0F, .column = 1, .intensity = 1}},
                          .column_time_ns = {0, 100},
                          .aims = {},
                          .places = {}};
    const TurnShape shape{.row_time_ns = {0}, .intensity = bytes, .beam_of = {}};
    const Frame frame = MakeTurnFrame(turn, shape, "turn").frame;
    EXPECT_EQ(frame.intensity, (std::vector<float>{0.0025F, 0.01F}));
    EXPECT_EQ(ByteOfIntensity(frame.intensity[0], bytes), 0);
  }
}

std::filesystem::path CaptureFile(const char* name) {
  return std::filesystem::path(RAILCAST_SHARED_DATA_DIR "/lidar_packets_nebula") / name;
}

std::size_t NumPoints(const Frame& frame) {
  std::size_t num = 0;
  for (const float x : frame.x) num += !std::isnan(x);
  return num;
}

// Nebula counts 14,831 points in the fourth turn.
TEST(CaptureRecording, IsNoFolderOfSuchAName) {
  const TemporaryDirectory directory;
  const auto bag = directory.path() / "drive.pcap";
  std::filesystem::create_directory(bag);
  EXPECT_FALSE(FindCapture(bag));
  EXPECT_FALSE(FindCapture(bag.string() + ":/points"));
}

TEST(CaptureRecording, OfARealVlp16HasFourTurnsInDualMode) {
  const auto file = CaptureFile("vlp16_dual.pcap");
  if (!exists(file)) GTEST_SKIP() << file << " is not there";
  const auto recording = OpenRecording(file);
  EXPECT_EQ(recording->info().kind, "capture of VLP-16");
  EXPECT_EQ(recording->info().num_frames, std::nullopt);
  const auto frames = ReadAll(*recording);
  ASSERT_EQ(frames.size(), 5U);
  for (std::size_t i = 0; i < 4; ++i) {
    const Frame& frame = frames[i].frame;
    EXPECT_EQ(frame.rows, 16U);
    EXPECT_EQ(frame.returns, 2U);
    EXPECT_NEAR(frame.columns, 1808.0, 2.0);
    EXPECT_NEAR(static_cast<double>(NumPoints(frame)), 14'850.0, 50.0);
  }
  EXPECT_EQ(frames[4].frame.columns, 4U);
}

// This sensor scanned half a turn: 909 of 1808 cycles.
TEST(CaptureRecording, OfARealVlp32cHasTheCyclesThatItFired) {
  const auto file = CaptureFile("vlp32c_single.pcap");
  if (!exists(file)) GTEST_SKIP() << file << " is not there";
  const auto frames = ReadAll(file);
  ASSERT_EQ(frames.size(), 6U);
  for (std::size_t i = 1; i < 5; ++i) {
    EXPECT_EQ(frames[i].frame.rows, 32U);
    EXPECT_EQ(frames[i].frame.columns, 909U);
    EXPECT_EQ(frames[i].frame.returns, 1U);
    EXPECT_NEAR(static_cast<double>(NumPoints(frames[i].frame)), 26'216.0, 50.0);
  }
}

TEST(CaptureRecording, OfARealPandar64HasFourTurnsInDualMode) {
  const auto file = CaptureFile("pandar64.pcap");
  if (!exists(file)) GTEST_SKIP() << file << " is not there";
  const auto recording = OpenRecording(file);
  EXPECT_EQ(recording->info().kind, "capture of Pandar64");
  const auto frames = ReadAll(*recording);
  ASSERT_EQ(frames.size(), 5U);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(frames[i].frame.rows, 64U);
    EXPECT_EQ(frames[i].frame.returns, 2U);
    EXPECT_NEAR(frames[i].frame.columns, 1800.0, 4.0);
    EXPECT_NEAR(static_cast<double>(NumPoints(frames[i].frame)), 93'591.0, 400.0);
  }
}

// The recording begins at 1.1 deg.
TEST(CaptureRecording, OfARealXt32HasFourTurnsInDualMode) {
  if (const std::string why = WhyNoHesaiBag("xt32"); !why.empty()) GTEST_SKIP() << why;
  const auto recording = OpenRecording(HesaiBag("xt32"));
  EXPECT_EQ(recording->info().kind, "capture of XT32");
  const auto frames = ReadAll(*recording);
  ASSERT_EQ(frames.size(), 5U);
  for (std::size_t i = 1; i < 4; ++i) {
    const Frame& frame = frames[i].frame;
    EXPECT_EQ(frame.rows, 32U);
    EXPECT_EQ(frame.returns, 2U);
    EXPECT_EQ(frame.columns, 2000U);
    EXPECT_NEAR(static_cast<double>(NumPoints(frame)), 63'040.0, 20.0);
    EXPECT_NEAR(static_cast<double>(frame.stamp_ns - frames[i - 1].frame.stamp_ns), 1e8,
                i == 1 ? 4e5 : 5e4);
  }
}

// The recording begins at 10.8 deg.
TEST(CaptureRecording, OfARealQt128HasTwoTurnsInDualMode) {
  if (const std::string why = WhyNoHesaiBag("qt128"); !why.empty()) GTEST_SKIP() << why;
  const auto recording = OpenRecording(HesaiBag("qt128"));
  EXPECT_EQ(recording->info().kind, "capture of QT128");
  const auto frames = ReadAll(*recording);
  ASSERT_EQ(frames.size(), 3U);
  EXPECT_EQ(frames[0].frame.columns, 436U);
  EXPECT_EQ(frames[1].frame.columns, 450U);
  EXPECT_EQ(frames[1].frame.rows, 192U);
  EXPECT_EQ(frames[1].frame.returns, 2U);
  EXPECT_EQ(NumPoints(frames[1].frame), 88'495U);
  EXPECT_THAT(recording->info().remarks->List(), testing::IsEmpty())
      << "all 1,800 packets have their three checksums";
}

// Its maker's manual says that the bytes are no reflectivity: of this one, two thirds are above
// 100.
TEST(CaptureRecording, OfARealQt64HasBytesOfUnknownScaleForIntensities) {
  if (const std::string why = WhyNoHesaiBag("qt64"); !why.empty()) GTEST_SKIP() << why;
  const auto frames = ReadAll(HesaiBag("qt64"));
  ASSERT_EQ(frames.size(), 5U);
  const RecordedFrame& turn = frames[1];
  EXPECT_EQ(turn.frame.columns, 600U);
  EXPECT_FALSE(turn.Has("intensity"));
  ASSERT_EQ(turn.foreign.size(), 1U);
  EXPECT_EQ(turn.foreign[0].name, "intensity_byte");
  std::size_t num_above_100 = 0;
  for (std::size_t i = 0; i < turn.frame.num_slots(); ++i) {
    const float byte = turn.foreign[0].values[i];
    ASSERT_EQ(std::isnan(byte), std::isnan(turn.frame.x[i]));
    ASSERT_TRUE(std::isnan(turn.frame.intensity[i]));
    num_above_100 += byte > 100.0F;
  }
  const auto num = static_cast<double>(NumPoints(turn.frame));
  EXPECT_NEAR(static_cast<double>(num_above_100) / num, 0.68, 0.005);
}

TEST(CaptureRecording, OfARealVls128HasThreeWholeTurns) {
  const auto file = CaptureFile("vls128_single.pcap");
  if (!exists(file)) GTEST_SKIP() << file << " is not there";
  const auto recording = OpenRecording(file);
  EXPECT_EQ(recording->info().kind, "capture of VLS-128");
  const auto frames = ReadAll(*recording);
  ASSERT_EQ(frames.size(), 5U);
  for (std::size_t i = 1; i < 4; ++i) {
    EXPECT_EQ(frames[i].frame.rows, 128U);
    EXPECT_NEAR(frames[i].frame.columns, 1809.0, 1.0);
    EXPECT_EQ(frames[i].frame.returns, 1U);
    EXPECT_NEAR(static_cast<double>(NumPoints(frames[i].frame)), 210'000.0, 100.0);
  }
}

/// Returns the error of OpenRecording for a capture of these payloads.
std::string MessageOfCapture(const std::vector<std::string>& payloads) {
  const TemporaryDirectory directory;
  const auto file = directory.path() / "a.pcap";
  WriteDatagrams(file, DatagramsWith(payloads));
  return MessageBehind(
      file.string() +
          ": must be a capture of VLP-16, HDL-32E, VLP-32C, VLS-128, Pandar64, XT32, "
          "QT128, Pandar128E4X, Pandar128E4X in standard mode, Pandar40P, QT64, XT16, XT32M or "
          "AT128 ",
      [&] { (void)OpenRecording(file); });
}

std::string VelodynePacketOf(std::uint8_t model, bool is_hdl64e = false) {
  std::string packet(kVelodynePacketSize, '\0');
  for (std::size_t block = 0; block < kBlocksPerPacket; ++block) {
    packet[block * kBlockSize] = '\xFF';
    packet[block * kBlockSize + 1] = is_hdl64e && block % 2 == 1 ? '\xDD' : '\xEE';
  }
  packet[kModePlace] = '\x37';
  packet[kModelPlace] = static_cast<char>(model);
  return packet;
}

/// Blocks of 124 bytes with Velodyne's flag, a tail of 22 bytes, and perhaps the packet's number.
std::string Pandar40PPacket(std::size_t size) {
  std::string packet(size, '\0');
  for (std::size_t block = 0; block < 10; ++block) packet.replace(124 * block, 2, "\xFF\xEE");
  return packet;
}

TEST(CaptureRecording, WithoutAKnownPacketSaysWhatWasFound) {
  EXPECT_EQ(MessageOfCapture({}), "(got no UDP datagram)");
  EXPECT_EQ(MessageOfCapture({"abc", "defgh"}), "(got 2 UDP datagrams, the first of 3 bytes)");
  EXPECT_EQ(MessageOfCapture({"abc", VelodynePacketOf(0x24)}), "(got Puck Hi-Res)");
  EXPECT_EQ(MessageOfCapture({VelodynePacketOf(0xA1)}),
            "(got VLS-128, of which only single returns are read)");
  EXPECT_EQ(MessageOfCapture({Pandar40PPacket(1262)}),
            "(got damaged packets of Hesai's Pandar40P)");
  EXPECT_EQ(MessageOfCapture({Pandar40PPacket(1266)}),
            "(got damaged packets of Hesai's Pandar40P)");
  EXPECT_EQ(MessageOfCapture({VelodynePacketOf(0x77)}), "(got Velodyne packets of model byte 119)");
  EXPECT_EQ(MessageOfCapture({VelodynePacketOf(0x77, true)}),
            "(got HDL-64E, whose packets lack its calibration)");
  EXPECT_EQ(MessageOfCapture({"RCST\1" + std::string(1200, '\0')}),
            "(got datagrams of protocol railcast, which railcast-analyze receive records)");
  EXPECT_EQ(MessageOfCapture({"\xEE\xFF" + std::string(1078, '\1')}),
            "(got packets of 1080 bytes of a Hesai sensor)");
}

TEST(CaptureRecording, LeavesOutPacketsWithAWrongChecksumAndCountsThem) {
  const ScanSpec scan = ReadSensor("qt128");
  const auto encoder =
      MakeSpinningEncoder(*FindSpinningModel("qt128"), scan, ReturnMode::kStrongest);
  Datagrams datagrams;
  encoder->Encode(MadeScan(scan).MakeFrame(0), datagrams);
  ASSERT_EQ(datagrams.items.size(), 450U);
  const TemporaryDirectory directory;
  const auto capture = [&](const std::string& name) {
    WriteDatagrams(directory.path() / name, datagrams);
    return OpenRecording(directory.path() / name);
  };
  const auto sound = capture("sound.pcap");
  EXPECT_EQ(ReadAll(*sound).at(0).frame.columns, 450U);
  EXPECT_THAT(sound->info().remarks->List(), testing::IsEmpty());
  // A byte of the blocks, one of the functional safety, and one of the tail.
  for (const std::size_t place : {500U, 1050U, 1080U}) {
    datagrams.bytes[datagrams.items[place / 5].offset + place] ^= 1;
  }
  const auto damaged = capture("damaged.pcap");
  EXPECT_EQ(ReadAll(*damaged).at(0).frame.columns, 447U);
  const std::vector<Remark> remarks = damaged->info().remarks->List();
  ASSERT_EQ(remarks.size(), 1U);
  EXPECT_EQ(remarks[0].kind, RemarkKind::kPacketsDamaged);
  EXPECT_EQ(remarks[0].number, 3U);
}

TEST(CaptureRecording, LeavesOutWhatIsNoPacketOfItsSensor) {
  const MadeScan scan(ReadSensor("vlp16"));
  Datagrams datagrams;
  for (const char byte : {'a', 'b'}) AddDatagram(std::string(100, byte), datagrams);
  const auto encoder =
      MakeSpinningEncoder(*FindSpinningModel("vlp16"), scan.spec(), ReturnMode::kStrongest);
  encoder->Encode(scan.MakeFrame(0), datagrams);
  const TemporaryDirectory directory;
  WriteDatagrams(directory.path() / "a.pcap", datagrams);
  EXPECT_EQ(ReadAll(directory.path() / "a.pcap").size(), 1U);
}

}  // namespace
}  // namespace railcast
