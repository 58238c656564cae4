#include "core/extras/packets/spinning/spinning_encoder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "core/base/units.h"
#include "core/extras/packets/spinning/spinning_decoder.h"
#include "core/extras/packets/spinning/spinning_packet.h"
#include "tests/core/extras/packets/hesai/made_packet.h"
#include "tests/core/extras/packets/hesai/sent_turns.h"
#include "tests/core/extras/packets/velodyne/made_scan.h"
#include "tests/core/io/message_of.h"
#include "tests/support/made_datagrams.h"
#include "tests/support/sensor_file.h"

namespace railcast {
namespace {

constexpr float kNoPoint = std::numeric_limits<float>::quiet_NaN();

class HesaiRoundTrip : public testing::TestWithParam<SentAs> {
 protected:
  const SpinningModel& model_ = *FindSpinningModel(GetParam().protocol);
  const MadeScan scan_{ReadSensor(FileOf(model_))};
  const std::uint32_t returns_ = GetParam().mode == ReturnMode::kDual ? 2 : 1;

  /// Whether the sensor can say a range.
  [[nodiscard]] bool IsSaid(float range_m, std::uint8_t laser) const {
    if (model_.near_m == 0.0) return !std::isnan(range_m);
    const bool sees_near = std::ranges::count(model_.near_lasers, laser) > 0;
    return range_m >= static_cast<float>(sees_near ? model_.near_m : model_.far_m);
  }

  /// The most by which a point may be off: half a unit of range, half a unit of the block's
  /// azimuth, and where decoders do not turn the rotor on, half the turn during a cycle's firings.
  [[nodiscard]] double Tolerance_m(double range_m) const {
    double azimuth_deg = 0.0051;
    if (model_.turns_azimuths) {
      azimuth_deg += 0.0018 * std::ranges::max(model_.channels, {}, &ChannelSpec::time_us).time_us;
    }
    return 0.0021 + range_m * RadFromDeg(azimuth_deg);
  }

  void ExpectColumn(const SensorTurn& turn,
                    std::uint32_t column,
                    const Frame& frame,
                    std::uint32_t in_frame) const;

  /// How many points a decoder makes of a firing: one of two returns that the packets say alike.
  [[nodiscard]] std::size_t NumSaid(const Frame& frame,
                                    std::size_t first,
                                    std::uint8_t laser) const;
};

std::size_t HesaiRoundTrip::NumSaid(const Frame& frame,
                                    std::size_t first,
                                    std::uint8_t laser) const {
  std::size_t num = 0;
  for (std::size_t slot = first; slot < first + returns_; ++slot) {
    num += IsSaid(frame.range_m[slot], laser);
  }
  if (num < 2) return num;
  const auto coded = [&](std::size_t slot) {
    return std::pair{std::lround(250.0F * frame.range_m[slot]),
                     std::lround(100.0F * std::min(frame.intensity[slot], 2.55F))};
  };
  return coded(first) == coded(first + 1) ? 1 : 2;
}

void HesaiRoundTrip::ExpectColumn(const SensorTurn& turn,
                                  std::uint32_t column,
                                  const Frame& frame,
                                  std::uint32_t in_frame) const {
  for (const TurnPoint& point : turn.points) {
    if (point.column != column) continue;
    const std::size_t first =
        point.ring * std::size_t{frame.width()} + std::size_t{in_frame} * returns_;
    double nearest_m = 1e9;
    for (std::size_t slot = first; slot < first + returns_; ++slot) {
      const double apart_m = std::hypot(static_cast<double>(frame.x[slot] - point.x),
                                        static_cast<double>(frame.y[slot] - point.y),
                                        static_cast<double>(frame.z[slot] - point.z));
      if (apart_m < nearest_m) nearest_m = apart_m;
    }
    ASSERT_LT(nearest_m, Tolerance_m(static_cast<double>(point.range_m))) << point.range_m;
    // Packets count microseconds, and loops whole nanoseconds.
    const std::int64_t fired_ns =
        kSimulationEpoch_s * kNsPerS + frame.stamp_ns + frame.time_ns[first];
    ASSERT_NEAR(static_cast<double>(turn.stamp_ns + point.time_ns - fired_ns), -500.0, 540.0);
  }
}

// Two frames without a gap. A decoder may begin a turn some columns before or after our frame, so
// the turns are taken as one.
TEST_P(HesaiRoundTrip, GivesThePointsOfTheFrames) {
  std::vector<Frame> frames;
  for (std::uint32_t i = 0; i < 2; ++i) frames.push_back(scan_.MakeFrame(i, returns_));
  const Datagrams datagrams = Encoded(model_, scan_, frames, GetParam().mode);
  EXPECT_TRUE(std::ranges::is_sorted(datagrams.items, {}, &Datagrams::Item::due_ns));
  const std::vector<SensorTurn> turns = TurnsIn(model_, datagrams);
  std::size_t num_points = 0;
  std::uint32_t before = 0;  // Columns of the turns before.
  for (const SensorTurn& turn : turns) {
    EXPECT_EQ(turn.is_dual, returns_ == 2);
    num_points += turn.points.size();
    // A column in twenty.
    for (std::uint32_t column = 0; column < turn.num_columns(); column += 20) {
      const std::uint32_t total = before + column;
      ExpectColumn(turn, column, frames.at(total / frames[0].columns), total % frames[0].columns);
      if (HasFatalFailure()) return;
    }
    before += static_cast<std::uint32_t>(turn.num_columns());
  }
  // A packet may lack its end.
  EXPECT_NEAR(before, 2.0 * frames[0].columns, static_cast<double>(model_.blocks));
  const std::vector<std::uint16_t> rows = RowsByElevation(model_.channels);
  std::size_t num_expected = 0;
  std::size_t channel = 0;
  for (const auto& loop : model_.loops) {
    for (const std::uint8_t laser : loop) {
      const std::size_t row = rows[channel++];
      for (std::uint32_t c = 0; c < before; ++c) {
        const Frame& frame = frames[c / frames[0].columns];
        const std::size_t first =
            row * std::size_t{frame.width()} + std::size_t{c % frame.columns} * returns_;
        num_expected += NumSaid(frame, first, laser);
      }
    }
  }
  EXPECT_EQ(num_points, num_expected);
}

INSTANTIATE_TEST_SUITE_P(
    Models, HesaiRoundTrip, testing::ValuesIn(Sendings()), [](const auto& test) {
      std::string name = test.param.protocol + "_" + std::string(NameOf(test.param.mode));
      std::ranges::replace(name, '-', '_');
      return name;
    });

std::uint8_t Byte(std::span<const char> packet, std::size_t place) {
  return static_cast<std::uint8_t>(packet[place]);
}

// The offsets are written out, so that they are not those of the table.
TEST(Pandar128e4xPacket, IsLaidOutAsItsMakerSays) {
  const SpinningModel& model = *FindSpinningModel("pandar128e4x");
  const MadeScan scan(ReadSensor("pandar128e4x"));
  Frame frame = scan.MakeFrame(0);
  const Datagrams datagrams = Encoded(model, scan, {frame});
  ASSERT_EQ(datagrams.items.size(), 1800U);
  const auto packet = datagrams.BytesOf(datagrams.items[3]);
  ASSERT_EQ(packet.size(), 861U);
  const std::vector<std::uint8_t> header(packet.begin(), packet.begin() + 12);
  EXPECT_THAT(header, testing::ElementsAre(0xEE, 0xFF, 1, 4, 0, 0, 128, 2, 0, 4, 1, 7));
  EXPECT_EQ(LoadAt<std::uint16_t>(packet.data() + 12), 60);   // 0.2 deg a packet
  EXPECT_EQ(LoadAt<std::uint16_t>(packet.data() + 398), 70);  // and 0.1 deg a block.
  EXPECT_EQ(LoadAt<std::uint16_t>(packet.data() + 814), 1U << 12U) << "azimuth states 0 and 1";
  EXPECT_EQ(Byte(packet, 816), 0) << "high resolution";
  EXPECT_EQ(Byte(packet, 817), 0x37) << "strongest";
  EXPECT_EQ(LoadAt<std::uint16_t>(packet.data() + 818), 600) << "revolutions per minute";
  const std::vector<std::uint8_t> date(packet.begin() + 820, packet.begin() + 826);
  EXPECT_THAT(date, testing::ElementsAre(100, 1, 1, 0, 0, 0)) << "2000-01-01, 43 us after midnight";
  // The second block begins 43.346 us after the stamp.
  const double begins_us = 3 * 55.5555556 + 27.778;
  EXPECT_EQ(LoadAt<std::uint32_t>(packet.data() + 826), std::floor(begins_us - 43.346));
  EXPECT_EQ(Byte(packet, 830), 0x42);
  EXPECT_EQ(LoadAt<std::uint32_t>(packet.data() + 831), 3U) << "the packet's number";
  EXPECT_EQ(LoadAt<std::uint32_t>(packet.data() + 784), HesaiCrc(packet.subspan(12, 772)));
  EXPECT_EQ(LoadAt<std::uint32_t>(packet.data() + 801), HesaiCrc(packet.subspan(789, 12)));
  EXPECT_EQ(LoadAt<std::uint32_t>(packet.data() + 857), HesaiCrc(packet.subspan(805, 52)));
}

std::uint16_t DistanceIn(std::span<const char> packet, std::size_t block, std::size_t laser) {
  return LoadAt<std::uint16_t>(packet.data() + 12 + 386 * block + 2 + 3 * laser);
}

// The central lasers fire in both states, groups of four of the others in turn: 96 in each block,
// with which the 36,000 blocks a second make the 3,456,000 points of the data sheet.
TEST(Pandar128e4xPacket, HasLasersInTurnInItsBlocks) {
  const SpinningModel& model = *FindSpinningModel("pandar128e4x");
  const MadeScan scan(ReadSensor("pandar128e4x"));
  Frame frame = scan.MakeFrame(0);
  std::ranges::fill(frame.range_m, 20.0F);
  std::ranges::fill(frame.outcome, Outcome::kReturned);
  const Datagrams datagrams = Encoded(model, scan, {frame});
  const auto packet = datagrams.BytesOf(datagrams.items[0]);
  for (std::size_t block = 0; block < 2; ++block) {
    std::size_t num_fired = 0;
    for (std::size_t laser = 0; laser < 128; ++laser) {
      const bool is_central = laser >= 24 && laser < 88;
      const bool fires = is_central || laser / 4 % 2 != block;
      EXPECT_EQ(DistanceIn(packet, block, laser), fires ? 5000 : 0) << block << " " << laser;
      num_fired += fires;
    }
    EXPECT_EQ(num_fired, 96U);
  }
}

/// The raw distance of laser 40 (which sees from 1.4 m on) or laser 45 (from 0.3 m on) of a firing
/// with this outcome.
std::uint16_t RawDistance(std::size_t laser, Outcome outcome, float range_m) {
  const SpinningModel& model = *FindSpinningModel("pandar128e4x-standard");
  static const MadeScan scan(ReadSensor("pandar128e4x_standard"));
  static Frame frame = scan.MakeFrame(0);
  const std::size_t slot = scan.RowOf(laser) * std::size_t{frame.width()};
  frame.outcome[slot] = outcome;
  frame.range_m[slot] = HasPoint(outcome) ? range_m : kNoPoint;
  frame.true_range_m[slot] = range_m;
  const Datagrams datagrams = Encoded(model, scan, {frame});
  return DistanceIn(datagrams.BytesOf(datagrams.items[0]), 0, laser);
}

TEST(Pandar128e4xPacket, SaysWhyThereIsNoPoint) {
  EXPECT_EQ(RawDistance(40, Outcome::kReturned, 2.0F), 500);
  EXPECT_EQ(RawDistance(40, Outcome::kReturned, 1.3F), 2) << "too near for this laser";
  EXPECT_EQ(RawDistance(45, Outcome::kReturned, 1.3F), 325);
  EXPECT_EQ(RawDistance(45, Outcome::kReturned, 0.2F), 1) << "too near for all";
  EXPECT_EQ(RawDistance(40, Outcome::kClutter, 1.0F), 2);
  EXPECT_EQ(RawDistance(40, Outcome::kNearRange, 0.2F), 1);
  EXPECT_EQ(RawDistance(40, Outcome::kEgo, 0.8F), 2);
  EXPECT_EQ(RawDistance(40, Outcome::kEgo, 1.6F), 3);
  EXPECT_EQ(RawDistance(40, Outcome::kCoverBlocked, 50.0F), 1) << "it is on the window";
  for (const Outcome outcome :
       {Outcome::kOutOfRange, Outcome::kBelowThreshold, Outcome::kRainAbsorbed,
        Outcome::kSensorDropout, Outcome::kNoFurtherEcho}) {
    EXPECT_EQ(RawDistance(40, outcome, 100.0F), 3) << OutcomeName(outcome);
    EXPECT_EQ(RawDistance(45, outcome, 1.0F), 3) << OutcomeName(outcome);
  }
  EXPECT_EQ(RawDistance(40, Outcome::kNoSurface, kNoPoint), 3);
}

TEST(Pandar128e4xPacket, SaysItOnceForBothReturns) {
  const SpinningModel& model = *FindSpinningModel("pandar128e4x-standard");
  const MadeScan scan(ReadSensor("pandar128e4x_standard"));
  Frame frame = scan.MakeFrame(0, 2);
  const std::size_t slot = scan.RowOf(40) * std::size_t{frame.width()};
  const auto set = [&](std::size_t i, float range_m) {
    frame.range_m[slot + i] = range_m;
    frame.outcome[slot + i] = std::isnan(range_m) ? Outcome::kNoFurtherEcho : Outcome::kReturned;
  };
  const auto said = [&](float strongest_m, float other_m) {
    set(0, strongest_m);
    set(1, other_m);
    const Datagrams datagrams = Encoded(model, scan, {frame}, ReturnMode::kDual);
    const auto packet = datagrams.BytesOf(datagrams.items[0]);
    return std::array<int, 2>{DistanceIn(packet, 0, 40), DistanceIn(packet, 1, 40)};
  };
  EXPECT_THAT(said(10.0F, 20.0F), testing::ElementsAre(5000, 2500));
  EXPECT_THAT(said(20.0F, 10.0F), testing::ElementsAre(5000, 2500));
  EXPECT_THAT(said(20.0F, kNoPoint), testing::ElementsAre(5000, 5000));
  EXPECT_THAT(said(1.0F, 20.0F), testing::ElementsAre(5000, 5000));
  EXPECT_THAT(said(kNoPoint, kNoPoint), testing::ElementsAre(3, 3));
}

// A second slot without a further echo does not say that nothing came back from what the first one
// says was too near.
TEST(Pandar128e4xPacket, SaysInBothReturnsWhatWasTooNear) {
  const SpinningModel& model = *FindSpinningModel("pandar128e4x-standard");
  const MadeScan scan(ReadSensor("pandar128e4x_standard"));
  for (const std::uint32_t returns : {1U, 2U}) {
    Frame frame = scan.MakeFrame(0, returns);
    const std::size_t slot = scan.RowOf(40) * std::size_t{frame.width()};
    std::fill_n(frame.range_m.begin() + static_cast<std::ptrdiff_t>(slot), returns, kNoPoint);
    frame.outcome[slot] = Outcome::kNearRange;
    if (returns == 2) frame.outcome[slot + 1] = Outcome::kNoFurtherEcho;
    const auto said = [&](float true_range_m) {
      frame.true_range_m[slot] = true_range_m;
      const Datagrams datagrams = Encoded(model, scan, {frame}, ReturnMode::kDual);
      const auto packet = datagrams.BytesOf(datagrams.items[0]);
      return std::array<int, 2>{DistanceIn(packet, 0, 40), DistanceIn(packet, 1, 40)};
    };
    EXPECT_THAT(said(0.2F), testing::ElementsAre(1, 1)) << returns;
    EXPECT_THAT(said(0.8F), testing::ElementsAre(2, 2)) << returns;
  }
}

// A frame of an XT32M, 2000 columns of 6 blocks, leaves a packet with 2 blocks.
TEST(HesaiEncoder, LeavesOutEveryPacketThatHasAPartOfAFrameLeftOut) {
  const SpinningModel& model = *FindSpinningModel("xt32m");
  const MadeScan scan(ReadSensor("xt32m"));
  std::vector<Frame> frames;
  for (std::uint32_t i = 0; i < 5; ++i) frames.push_back(scan.MakeFrame(i));
  const Datagrams all = Encoded(model, scan, frames);
  ASSERT_EQ(all.items.size(), 1666U);  // 10,000 blocks.
  frames.erase(frames.begin() + 2);
  const Datagrams some = Encoded(model, scan, frames);
  std::vector<std::string> expected;
  for (std::size_t i = 0; i < all.items.size(); ++i) {
    const auto bytes = all.BytesOf(all.items[i]);
    EXPECT_EQ(LoadAt<std::uint32_t>(bytes.data() + 816), i) << "the packet's number";
    if (6 * (i + 1) <= 4000 || 6 * i >= 6000) expected.emplace_back(bytes.begin(), bytes.end());
  }
  const std::vector<std::string> got = PayloadTexts(some);
  EXPECT_EQ(got.size(), expected.size());
  EXPECT_TRUE(got == expected);
}

TEST(HesaiEncoder, StatesTheTimeAndDateOfItsStamp) {
  const SpinningModel& model = Xt32Model();
  const MadeScan scan(ReadSensor("xt32"));
  Frame frame = scan.MakeFrame(0);
  constexpr std::int64_t kDay_ns = 86'400'000'000'000;
  frame.stamp_ns = 59 * kDay_ns + 3'661 * kNsPerS + 1'234'567;  // 2000-02-29 01:01:01.
  const Datagrams datagrams = Encoded(model, scan, {frame});
  const auto packet = datagrams.BytesOf(datagrams.items[0]);
  const std::vector<std::uint8_t> date(packet.begin() + 1065, packet.begin() + 1071);
  EXPECT_THAT(date, testing::ElementsAre(100, 2, 29, 1, 1, 1));
  // The last of 8 blocks begins 350 us after the first, 6 us after the command to fire.
  EXPECT_EQ(LoadAt<std::uint32_t>(packet.data() + 1071), 1'234 + 350 - 6);
  EXPECT_EQ(datagrams.items[0].due_ns, frame.stamp_ns + 350'000 + 31 * 1'512);
}

TEST(HesaiEncoder, SaysReflectivityInPercent) {
  const MadeScan scan(ReadSensor("pandar64"));
  Frame frame = scan.MakeFrame(0);
  const std::vector<float> intensities = {0.5F, 1.004F, 1.5F, 100.0F, kNoPoint};
  for (std::size_t laser = 0; laser < intensities.size(); ++laser) {
    const std::size_t slot = scan.RowOf(laser) * std::size_t{frame.width()};
    frame.intensity[slot] = intensities[laser];
    frame.range_m[slot] = 10.0F;
  }
  const Datagrams datagrams = Encoded(Pandar64Model(), scan, {frame});
  std::vector<int> said;
  for (std::size_t laser = 0; laser < intensities.size(); ++laser) {
    said.push_back(Byte(datagrams.BytesOf(datagrams.items[0]), 10 + 3 * laser + 2));
  }
  EXPECT_THAT(said, testing::ElementsAre(50, 100, 150, 255, 0));
}

std::string HesaiFitSaid(const std::string& protocol,
                         const std::string& sensor,
                         ReturnMode return_mode = ReturnMode::kStrongest) {
  return MessageOf([&] {
    (void)MakeSpinningEncoder(*FindSpinningModel(protocol), ReadSensor(sensor), return_mode);
  });
}

TEST(HesaiFit, TakesTheSensorsThatShip) {
  for (const SpinningModel& model : HesaiModels()) {
    for (const ReturnMode mode :
         {ReturnMode::kStrongest, ReturnMode::kFirst, ReturnMode::kLast, ReturnMode::kDual}) {
      EXPECT_EQ(HesaiFitSaid(std::string(model.protocol), FileOf(model), mode), "no error");
    }
  }
}

TEST(HesaiFit, SaysWhatDoesNotFit) {
  EXPECT_EQ(FindSpinningModel("vlp-16"), nullptr);
  EXPECT_EQ(HesaiFitSaid("pandar128e4x", "pandar128e4x_standard"),
            "--protocol pandar128e4x: /lidar/scan/pattern/channels: must be 192 as Pandar128E4X "
            "has (got 128)");
  EXPECT_EQ(HesaiFitSaid("xt32", "xt32m"),
            "--protocol xt32: /lidar/scan/pattern/channels/0/elevation_deg: must be 14.972363 as "
            "of XT32 (got 19.407)");
  EXPECT_EQ(HesaiFitSaid("pandar64", "pandar64", ReturnMode::kTriple),
            "--protocol pandar64: /lidar/receiver/return_mode: must be \"strongest\", \"first\", "
            "\"last\" or \"dual\" (got \"triple\")");
}

}  // namespace
}  // namespace railcast
