#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/base/units.h"
#include "core/extras/packets/recording/capture_sensor.h"
#include "core/extras/packets/spinning/spinning_decoder.h"
#include "core/extras/packets/spinning/spinning_encoder.h"
#include "core/extras/packets/spinning/spinning_packet.h"
#include "core/io/field_layout.h"
#include "tests/core/extras/packets/hesai/sent_turns.h"
#include "tests/core/extras/packets/velodyne/made_scan.h"
#include "tests/core/io/message_of.h"
#include "tests/support/sensor_file.h"

namespace railcast {
namespace {

/// The model of the unit whose correction file is the preset's.
SpinningModel ModelOfPreset() {
  return At128Model(std::make_shared<const At128Correction>(
      ReadAt128Correction(RAILCAST_SOURCE_DIR "/scenarios/sensors/at128.dat")));
}

class At128RoundTrip : public testing::TestWithParam<ReturnMode> {
 protected:
  At128RoundTrip() {
    for (std::uint32_t i = 0; i < 4; ++i) frames_.push_back(scan_.MakeFrame(i, returns_));
    datagrams_ = Encoded(*FindSpinningModel("at128"), scan_, frames_, GetParam());
  }

  const MadeScan scan_{ReadSensor("at128")};
  const std::uint32_t returns_ = GetParam() == ReturnMode::kDual ? 2 : 1;
  std::vector<Frame> frames_;
  Datagrams datagrams_;
};

TEST_P(At128RoundTrip, GivesThePointsOfTheFrames) {
  EXPECT_TRUE(std::ranges::is_sorted(datagrams_.items, {}, &Datagrams::Item::due_ns));
  const std::vector<SensorTurn> turns = TurnsIn(ModelOfPreset(), datagrams_);
  ASSERT_EQ(turns.size(), frames_.size());
  for (std::size_t i = 0; i < turns.size(); ++i) {
    const Frame& frame = frames_[i];
    ASSERT_EQ(turns[i].num_columns(), 1200U);
    EXPECT_EQ(turns[i].is_dual, returns_ == 2);
    EXPECT_GT(turns[i].points.size(), frame.num_slots() * 8 / 10);
    for (const TurnPoint& point : turns[i].points) {
      const std::size_t first =
          point.ring * std::size_t{frame.width()} + std::size_t{point.column} * returns_;
      double nearest_m = 1e9;
      for (std::size_t slot = first; slot < first + returns_; ++slot) {
        const double apart_m = std::hypot(static_cast<double>(frame.x[slot] - point.x),
                                          static_cast<double>(frame.y[slot] - point.y),
                                          static_cast<double>(frame.z[slot] - point.z));
        if (apart_m < nearest_m) nearest_m = apart_m;
      }
      // Half a unit of range. The directions are those of the packets' azimuths, in float32.
      ASSERT_LT(nearest_m, 0.00201 + 1e-6 * static_cast<double>(point.range_m));
      const std::int64_t fired_ns =
          kSimulationEpoch_s * kNsPerS + frame.stamp_ns + frame.time_ns[first];
      ASSERT_NEAR(static_cast<double>(turns[i].stamp_ns + point.time_ns - fired_ns), -500.0, 510.0);
    }
  }
}

TEST_P(At128RoundTrip, SendsWhatItReadsAgainByteByByte) {
  const SpinningModel model = ModelOfPreset();
  const TurnShape shape = ShapeOfTurns(model.channels, model.intensity, BeamsOfSpinning(model));
  std::vector<Frame> read;
  for (const SensorTurn& turn : TurnsIn(model, datagrams_)) {
    Frame& frame = read.emplace_back(MakeTurnFrame(turn, shape, "turn").frame);
    frame.index = static_cast<std::uint32_t>(read.size() - 1);
    // Packets state whole microseconds, so that the turn's may be one less.
    frame.stamp_ns = frames_[frame.index].stamp_ns;
  }
  const Datagrams again = Encoded(*FindSpinningModel("at128"), scan_, read, GetParam());
  EXPECT_TRUE(again.bytes == datagrams_.bytes);
}

INSTANTIATE_TEST_SUITE_P(Modes,
                         At128RoundTrip,
                         testing::Values(ReturnMode::kStrongest, ReturnMode::kDual),
                         [](const auto& test) { return std::string(NameOf(test.param)); });

// The layout of HesaiLidar_SDK_2.0, udp_protocol_v4_3.h.
TEST(At128Packet, HasItsFieldsWhereTheMakersDecoderReadsThem) {
  const MadeScan scan(ReadSensor("at128"));
  const std::vector<Frame> frames = {scan.MakeFrame(0), scan.MakeFrame(1)};
  const Datagrams sent = Encoded(*FindSpinningModel("at128"), scan, frames);
  ASSERT_EQ(sent.items.size(), 1200U);
  const auto bytes = [&](std::size_t packet) { return sent.BytesOf(sent.items[packet]); };
  const auto azimuth_deg = [&](std::size_t packet, std::size_t block) {
    const char* const place = bytes(packet).data() + 12 + 515 * block;
    return (256 * LoadAt<std::uint16_t>(place) + LoadAt<std::uint8_t>(place + 2)) / 25'600.0;
  };
  const std::span<const char> packet = bytes(0);
  ASSERT_EQ(packet.size(), 1118U);
  // The marks, version 4.3, 128 lasers, 2 blocks, single returns, 4 mm, one return; there are a
  // number, a signature and confidences.
  EXPECT_EQ(std::string(packet.data(), 12),
            std::string("\xEE\xFF\x04\x03\0\0\x80\x02\0\x04\x01\x19", 12));
  // The fields start at 20, 140 and 260 deg; 45 deg on is the middle of a sweep.
  const double step_deg = 120.0 * 10.0 * 41.666e-6;
  EXPECT_NEAR(azimuth_deg(0, 0), 20.0 + 45.0 - 599.5 * step_deg, 1.0 / 25'600.0);
  EXPECT_NEAR(azimuth_deg(0, 1) - azimuth_deg(0, 0), step_deg, 1.0 / 25'600.0);
  EXPECT_NEAR(azimuth_deg(600, 0) - azimuth_deg(0, 0), 120.0, 1.0 / 25'600.0);
  // Laser 1 is the highest.
  std::size_t column = 0;
  while (std::isnan(frames[0].range_m[127 * 1200 + column])) column += 2;
  const char* const laser = bytes(column / 2).data() + 15;
  EXPECT_EQ(LoadAt<std::uint16_t>(laser),
            std::lround(250.0F * frames[0].range_m[127 * 1200 + column]));
  EXPECT_EQ(LoadAt<std::uint8_t>(laser + 2), PercentByte(frames[0].intensity[127 * 1200 + column]));
  EXPECT_EQ(LoadAt<std::uint8_t>(laser + 3), 0U);
  EXPECT_EQ(LoadAt<std::uint32_t>(packet.data() + 1042), HesaiCrc(packet.subspan(12, 1030)));
  EXPECT_EQ(LoadAt<std::int16_t>(packet.data() + 1064), 200);
  // 9.249 us and a block after the last block's begin.
  EXPECT_EQ(LoadAt<std::uint32_t>(packet.data() + 1066), 92U);
  // The strongest; 946,684,800 s since 1970, the highest byte first.
  EXPECT_EQ(std::string(packet.data() + 1070, 8), std::string("\x37\x42\0\0\x38\x6D\x43\x80", 8));
  EXPECT_EQ(LoadAt<std::uint32_t>(bytes(1199).data() + 1078), 1199U);
  EXPECT_EQ(LoadAt<std::uint32_t>(packet.data() + 1082), HesaiCrc(packet.subspan(1046, 36)));
}

TEST(At128Fit, SaysWhatDoesNotFit) {
  const auto said = [](const char* protocol, const char* sensor, ReturnMode mode) {
    return MessageOf(
        [&] { (void)MakeSpinningEncoder(*FindSpinningModel(protocol), ReadSensor(sensor), mode); });
  };
  const std::string no_file =
      "--protocol at128: /lidar/scan/pattern: must be a table whose file is the correction file of "
      "an AT128";
  EXPECT_EQ(said("at128", "xt32", ReturnMode::kStrongest), no_file);
  EXPECT_EQ(said("at128", "rosette", ReturnMode::kStrongest), no_file);
  EXPECT_EQ(said("at128", "at128", ReturnMode::kFirst),
            "--protocol at128: /lidar/receiver/return_mode: must be \"strongest\", \"last\" or "
            "\"dual\" (got \"first\")");
  EXPECT_EQ(said("xt32", "at128", ReturnMode::kStrongest),
            "--protocol xt32: /lidar/scan/pattern/type: must be \"spinning\"");
}

}  // namespace
}  // namespace railcast
