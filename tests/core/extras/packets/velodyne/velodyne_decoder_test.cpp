#include "core/extras/packets/spinning/spinning_decoder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <tuple>

#include "core/base/units.h"
#include "core/extras/packets/velodyne/velodyne_packet.h"
#include "core/io/field_layout.h"
#include "railcast/transform.h"
#include "tests/core/extras/packets/velodyne/made_scan.h"
#include "tests/support/decode_packet.h"
#include "tests/support/sensor_file.h"

namespace railcast {
namespace {

SpinningDecoder DecoderOf(std::string_view format, const MadeScan& scan) {
  SpinningModel model = *FindSpinningModel(format);
  if (model.has_own_angles) model.channels = scan.spinning().channels;
  return SpinningDecoder(model);
}

std::vector<SensorTurn> DecodeAll(SpinningDecoder& decoder, const Datagrams& datagrams) {
  std::vector<SensorTurn> turns;
  for (const auto& packet : DataPackets(datagrams)) {
    EXPECT_EQ(DecodePacket(decoder, packet, turns), std::nullopt);
  }
  return turns;
}

/// A slot of a frame that must become a point.
struct Expected {
  std::size_t slot{};
  std::size_t laser{};
  std::uint8_t return_index{};
};

/// Returns the slots that packets hold, in the order of the packets.
std::vector<Expected> PointsOf(const Frame& frame,
                               const MadeScan& scan,
                               const SpinningModel& model) {
  std::vector<Expected> points;
  const auto units = [&](std::size_t slot) {
    const double distance =
        std::floor(static_cast<double>(frame.range_m[slot]) / (1e-3 * model.unit_mm) + 0.5);
    return distance < 65536.0 ? distance : 0.0;  // NaN gives 0, too.
  };
  for (std::uint32_t column = 0; column < frame.columns; ++column) {
    for (std::size_t laser = 0; laser < scan.num_lasers(); ++laser) {
      const std::size_t slot =
          scan.RowOf(laser) * std::size_t{frame.width()} + std::size_t{column} * frame.returns;
      std::vector<std::size_t> slots;
      for (std::size_t r = 0; r < frame.returns; ++r) {
        if (units(slot + r) > 0.0) slots.push_back(slot + r);
      }
      std::ranges::sort(slots, [&](std::size_t a, std::size_t b) { return units(a) > units(b); });
      for (std::size_t i = 0; i < slots.size(); ++i) {
        points.push_back({slots[i], laser, static_cast<std::uint8_t>(i)});
      }
    }
  }
  return points;
}

using Window = std::optional<std::array<double, 2>>;

ScanSpec InWindow(ScanSpec scan, const Window& window_deg) {
  std::get<SpinningSpec>(scan.pattern).azimuth_window_deg = window_deg;
  return scan;
}

class DecodedFormat : public testing::TestWithParam<std::tuple<const char*, Window>> {};

TEST_P(DecodedFormat, GivesBackTheFramesThatWereEncoded) {
  const std::string_view format = std::get<0>(GetParam());
  const Window& window_deg = std::get<1>(GetParam());
  const MadeScan scan(InWindow(ReadSensor(std::string(SensorOf(format))), window_deg));
  const SpinningModel& model = *FindSpinningModel(format);
  const std::uint32_t returns = format == "vlp16-dual" ? 2 : 1;
  std::vector<Frame> frames;
  for (std::uint32_t i = 0; i < 3; ++i) frames.push_back(scan.MakeFrame(i, returns));
  SpinningDecoder decoder = DecoderOf(format, scan);
  const auto turns = DecodeAll(decoder, EncodeAll(format, scan, frames));
  ASSERT_EQ(turns.size(), 2U);  // The third turn would end where a fourth begins.
  // A packet that spans two frames has a single time and speed, so it does not account for the gap
  // between the frames.
  const double gap_us =
      1e6 / scan.spec().rate_hz - scan.spinning().columns * scan.spinning().cycle_us;
  // After the gap of a window it is taken from the rotor's azimuth.
  const double window_us = window_deg ? scan.spinning().cycle_us : 0.0;
  const std::int64_t time_tolerance_ns = 1001 + std::lround(1e3 * (gap_us + window_us));
  // Azimuths and the steps between blocks are rounded to 0.01 deg.
  constexpr double kAzimuthTolerance_deg = 0.02;
  for (std::size_t t = 0; t < turns.size(); ++t) {
    const Frame& frame = frames[t];
    const auto expected = PointsOf(frame, scan, model);
    const auto& points = turns[t].points;
    ASSERT_EQ(points.size(), expected.size());
    const std::int64_t begin_ns = frame.stamp_ns + *std::ranges::min_element(frame.time_ns);
    EXPECT_LT(std::abs(turns[t].stamp_ns - begin_ns), time_tolerance_ns);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const std::size_t slot = expected[i].slot;
      ASSERT_EQ(points[i].laser, expected[i].laser);
      ASSERT_EQ(points[i].ring, frame.ring[slot]);
      ASSERT_EQ(points[i].return_index, expected[i].return_index);
      ASSERT_EQ(points[i].intensity, ReflectivityByte(frame.intensity[slot]));
      ASSERT_NEAR(points[i].range_m, frame.range_m[slot], 0.5 * (1e-3 * model.unit_mm) + 2e-5);
      const std::int64_t fired_ns = turns[t].stamp_ns + points[i].time_ns - frame.stamp_ns;
      ASSERT_LT(std::abs(fired_ns - frame.time_ns[slot]), time_tolerance_ns);
      const double azimuth_deg = DegFromRad(static_cast<double>(points[i].azimuth_rad));
      ASSERT_LT(std::abs(std::remainder(azimuth_deg - MadeScan::AzimuthOf(frame, slot), 360.0)),
                kAzimuthTolerance_deg);
      const Eigen::Vector3f decoded_m(points[i].x, points[i].y, points[i].z);
      const Eigen::Vector3f true_m(frame.x[slot], frame.y[slot], frame.z[slot]);
      ASSERT_LT(static_cast<double>((decoded_m - true_m).norm()),
                (1e-3 * model.unit_mm) +
                    static_cast<double>(true_m.norm()) * RadFromDeg(kAzimuthTolerance_deg));
    }
  }
}

// A window that begins within a block of VLP-16, and one over 0.
INSTANTIATE_TEST_SUITE_P(
    VelodyneDecoder,
    DecodedFormat,
    testing::Combine(testing::Values("vlp16", "vlp16-dual", "hdl32e", "vlp32c", "vls128", "hdl64e"),
                     testing::Values(Window{}, Window{{100.3, 200.0}}, Window{{300.0, 60.0}})),
    [](const auto& test) {
      std::string name = std::get<0>(test.param);
      std::erase(name, '-');
      const Window& window_deg = std::get<1>(test.param);
      return window_deg ? name + "From" + std::to_string(std::lround((*window_deg)[0])) : name;
    });

TEST(VelodynePackets, OfAWindowAreAsManyAsItsBlocksFill) {
  const MadeScan scan(InWindow(ReadSensor("vlp16"), {{90.0, 180.0}}));
  const Datagrams datagrams =
      EncodeAll("vlp16", scan, {scan.MakeFrame(0), scan.MakeFrame(1), scan.MakeFrame(2)});
  const auto packets = DataPackets(datagrams);
  // The cycles 453 to 904 of 0.199066 deg each begin in the window. They take the blocks of two
  // cycles from 226 to 452, of which both ends have a cycle that has not fired.
  EXPECT_EQ(packets.size(), std::size_t{3 * 227 / 12});
  for (const auto& packet : packets) {
    for (std::size_t block = 0; block < kBlocksPerPacket; ++block) {
      const auto azimuth =
          LoadAt<std::uint16_t>(packet.data() + block * kBlockSize + kAzimuthPlace);
      ASSERT_TRUE(azimuth >= 8'998 && azimuth <= 17'996) << azimuth;
    }
  }
}

/// Returns a valid VLP-16 packet.
std::vector<char> SoundPacket(std::string_view format = "vlp16") {
  const MadeScan scan(ReadSensor(std::string(SensorOf(format))));
  const Datagrams datagrams = EncodeAll(format, scan, {scan.MakeFrame(0)});
  const auto packet = DataPackets(datagrams)[0];
  return {packet.begin(), packet.end()};
}

std::string Refusal(std::string_view format, std::span<const char> packet) {
  const MadeScan scan(ReadSensor(std::string(SensorOf(format))));
  SpinningDecoder decoder = DecoderOf(format, scan);
  std::vector<SensorTurn> turns;
  std::string refusal = DecodePacket(decoder, packet, turns).value_or("");
  if (!refusal.empty()) {
    EXPECT_TRUE(turns.empty());
    EXPECT_TRUE(decoder.TakeUnfinished().points.empty());
  }
  return refusal;
}

template <typename Number>
std::string RefusalWith(std::string_view format, std::size_t place, Number number) {
  std::vector<char> packet = SoundPacket(format);
  StoreAt<Number>(packet.data() + place, number);
  return Refusal(format, packet);
}

TEST(VelodyneDecoder, RefusesWhatIsNoPacketOfItsModel) {
  std::vector<char> packet = SoundPacket();
  EXPECT_EQ(Refusal("vlp16", packet), "");
  EXPECT_EQ(Refusal("vlp16", {}), "must be 1206 bytes (got 0)");
  EXPECT_EQ(Refusal("vlp16", std::span(packet).first(1205)), "must be 1206 bytes (got 1205)");
  packet.push_back('\0');
  EXPECT_EQ(Refusal("vlp16", packet), "must be 1206 bytes (got 1207)");
  EXPECT_EQ(RefusalWith<std::uint8_t>("vlp16", 1205, 0x21), "model must be 34, VLP-16 (got 33)");
  EXPECT_EQ(RefusalWith<std::uint8_t>("vlp16", 1204, 0x36),
            "return mode must be 55, 56 or 57 (got 54)");
  EXPECT_EQ(RefusalWith<std::uint16_t>("vlp16", 700, 0xDDFF),
            "block 7: flag must be 61183 (got 56831)");
  EXPECT_EQ(RefusalWith<std::uint16_t>("vlp16", 302, 36000),
            "block 3: azimuth must be <= 35999 (got 36000)");
  EXPECT_EQ(RefusalWith<std::uint32_t>("vlp16", 1200, 3'600'000'000U),
            "microseconds past the hour must be < 3600000000 (got 3600000000)");
  EXPECT_EQ(RefusalWith<std::uint16_t>("vlp16-dual", 302, 77),
            "block 3: azimuth must be that of its pair (got 77)");
  EXPECT_EQ(RefusalWith<std::uint16_t>("hdl64e", 500, 0xEEFF),
            "block 5: flag must be 56831 (got 61183)");
}

// A cycle of VLS-128 takes four blocks. Laser 127 fires 17 slots after laser 0, one slot of 2.665
// us for each group of eight and one of maintenance, in which the rotor turns by 0.16 deg.
TEST(VelodyneDecoder, TakesTheLasersOfAVls128FromFourBlocks) {
  constexpr std::array<std::uint16_t, 4> kFlags = {0xEEFF, 0xDDFF, 0xCCFF, 0xBBFF};
  std::vector<char> packet(kVelodynePacketSize, '\0');
  for (std::size_t block = 0; block < kBlocksPerPacket; ++block) {
    char* const place = packet.data() + block * kBlockSize;
    StoreAt<std::uint16_t>(place, kFlags[block % 4]);
    StoreAt<std::uint16_t>(place + kAzimuthPlace, static_cast<std::uint16_t>(19 * (block / 4)));
  }
  StoreAt<std::uint8_t>(packet.data() + kModePlace, kStrongestMode);
  StoreAt<std::uint8_t>(packet.data() + kModelPlace, 0xA1);
  const auto set_distance = [&](std::size_t block, std::size_t laser) {
    StoreAt<std::uint16_t>(packet.data() + block * kBlockSize + kReturnsPlace + laser * kReturnSize,
                           2500);
  };
  set_distance(0, 0);
  set_distance(3, 31);
  SpinningDecoder decoder(ModelNamed("VLS-128"));
  std::vector<SensorTurn> turns;
  ASSERT_EQ(DecodePacket(decoder, packet, turns), std::nullopt);
  const SensorTurn turn = decoder.TakeUnfinished();
  ASSERT_EQ(turn.num_columns(), 3U);
  ASSERT_EQ(turn.points.size(), 2U);
  EXPECT_EQ(turn.points[0].laser, 0);
  EXPECT_EQ(turn.points[1].laser, 127);
  for (const TurnPoint& point : turn.points) EXPECT_FLOAT_EQ(point.range_m, 10.0F);  // 4 mm each.
  EXPECT_NEAR(DegFromRad(static_cast<double>(turn.points[0].azimuth_rad)), 6.354, 1e-4);
  const double turned_deg = 0.19 * 16.0 * 2.665 / 55.277;
  EXPECT_NEAR(DegFromRad(static_cast<double>(turn.points[1].azimuth_rad)),
              360.0 - 6.354 + turned_deg, 1e-4);
  StoreAt<std::uint16_t>(packet.data() + 2 * kBlockSize, 0xEEFF);
  EXPECT_EQ(DecodePacket(decoder, packet, turns), "block 2: flag must be 52479 (got 61183)");
  StoreAt<std::uint8_t>(packet.data() + kModePlace, kLastAndStrongestMode);
  EXPECT_EQ(DecodePacket(decoder, packet, turns), "return mode must be 55 or 56 (got 57)");
}

TEST(VelodyneDecoder, KnowsTheLasersOfAVls128AsItsSensorFileDoes) {
  const auto spinning = std::get<SpinningSpec>(ReadSensor("vls128").pattern);
  const SpinningModel& model = ModelNamed("VLS-128");
  EXPECT_EQ(spinning.cycle_us, model.cycle_us);
  ASSERT_EQ(spinning.channels.size(), model.channels.size());
  for (std::size_t i = 0; i < model.channels.size(); ++i) {
    EXPECT_EQ(spinning.channels[i].elevation_deg, model.channels[i].elevation_deg) << i;
    EXPECT_EQ(spinning.channels[i].azimuth_deg, model.channels[i].azimuth_deg) << i;
    // The file has microseconds to three places.
    EXPECT_NEAR(spinning.channels[i].time_us, model.channels[i].time_us, 0.0005001) << i;
  }
}

TEST(VelodyneDecoder, CountsOnOverTheHour) {
  std::vector<char> packet = SoundPacket();
  SpinningDecoder decoder(*FindSpinningModel("vlp16"));
  std::vector<SensorTurn> turns;
  // Every packet begins at azimuth 0, so each is a turn.
  for (const std::uint32_t time_us : {3'599'900'000U, 0U, 100'000U, 50'000U, 2'000'000'000U}) {
    StoreAt<std::uint32_t>(packet.data() + 1200, time_us);
    EXPECT_EQ(DecodePacket(decoder, packet, turns), std::nullopt);
  }
  turns.push_back(decoder.TakeUnfinished());
  std::vector<std::int64_t> stamps_us;
  for (const SensorTurn& turn : turns) stamps_us.push_back(turn.stamp_ns / 1000);
  // The fourth packet came late; a time half an hour or more ahead is taken for an earlier one.
  EXPECT_THAT(stamps_us, testing::ElementsAre(3'599'900'000, 3'600'000'000, 3'600'100'000,
                                              3'600'050'000, 2'000'000'000));
}

TEST(VelodyneDecoder, SurvivesAClockThatLeaps) {
  std::vector<char> packet = SoundPacket();
  SpinningDecoder decoder(*FindSpinningModel("vlp16"));
  std::vector<SensorTurn> turns;
  std::int64_t last_ns = 0;
  for (std::uint32_t i = 0; i < 25'000; ++i) {
    // Each packet comes 29.9 minutes after the one before: 12,458 hours in all.
    StoreAt<std::uint32_t>(packet.data() + 1200,
                           static_cast<std::uint32_t>(i * 1'794'000'000ULL % 3'600'000'000ULL));
    ASSERT_EQ(DecodePacket(decoder, packet, turns), std::nullopt);
    if (turns.empty()) continue;
    last_ns = std::max(last_ns, turns.back().stamp_ns);
    turns.clear();
  }
  EXPECT_GT(last_ns, 9'999 * 3'600'000'000'000);
  EXPECT_LT(last_ns, 10'001 * 3'600'000'000'000);
}

TEST(VelodyneDecoder, CutsTheTurnOfARotorThatStandsStill) {
  std::vector<char> packet = SoundPacket();
  for (std::size_t block = 0; block < 12; ++block) {
    StoreAt<std::uint16_t>(packet.data() + block * kBlockSize + kAzimuthPlace, 100);
  }
  SpinningDecoder decoder(*FindSpinningModel("vlp16"));
  std::vector<SensorTurn> turns;
  for (int i = 0; turns.empty() && i < 10'000; ++i) {
    ASSERT_EQ(DecodePacket(decoder, packet, turns), std::nullopt);
  }
  ASSERT_EQ(turns.size(), 1U);
  EXPECT_LT(turns[0].points.size(), (std::size_t{1} << 20U) + 32);
}

}  // namespace
}  // namespace railcast
