#include "core/extras/packets/ouster/ouster_encoder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/units.h"
#include "core/extras/packets/ouster/ouster_decoder.h"
#include "core/extras/packets/velodyne/velodyne_packet.h"
#include "core/io/field_layout.h"
#include "tests/core/extras/packets/ouster/made_ouster.h"
#include "tests/core/extras/packets/velodyne/made_scan.h"
#include "tests/core/io/message_of.h"
#include "tests/support/ouster_metadata_text.h"

namespace railcast {
namespace {

class EncodedProfile : public testing::TestWithParam<const char*> {};

TEST_P(EncodedProfile, IsDecodedToTheFramesItCameFrom) {
  const MadeOuster sensor(MadeOusterMetadataText(GetParam()));
  const std::vector<SensorTurn> turns = sensor.Decode(sensor.Encode({0, 1}));
  ASSERT_EQ(turns.size(), 2U);
  const OusterLayout layout(sensor.metadata());
  // Half a unit, and what float32 makes of 150 m.
  const double tolerance_m = 0.5e-3 * layout.range_unit_mm() + 2e-5;
  for (std::uint32_t index = 0; index < 2; ++index) {
    const Frame frame = sensor.MakeFrame(index);
    const SensorTurn& turn = turns[index];
    EXPECT_EQ(turn.stamp_ns, kSimulationEpoch_s * kNsPerS + frame.stamp_ns);
    EXPECT_EQ(turn.num_columns(), frame.columns);
    std::vector<bool> is_found(frame.num_slots());
    for (const TurnPoint& point : turn.points) {
      const std::size_t slot = point.ring * std::size_t{frame.width()} +
                               point.column * frame.returns + point.return_index;
      is_found[slot] = true;
      ASSERT_NEAR(point.range_m, frame.range_m[slot], tolerance_m);
      // The unit along the beam.
      ASSERT_NEAR(point.x, frame.x[slot], tolerance_m);
      ASSERT_NEAR(point.y, frame.y[slot], tolerance_m);
      ASSERT_NEAR(point.z, frame.z[slot], tolerance_m);
      ASSERT_EQ(point.intensity, ReflectivityByte(frame.intensity[slot]));
      ASSERT_EQ(point.time_ns, frame.time_ns[slot]);
    }
    for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
      ASSERT_EQ(is_found[slot], !std::isnan(frame.range_m[slot]));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(OusterEncoder,
                         EncodedProfile,
                         testing::Values("LEGACY",
                                         "RNG19_RFL8_SIG16_NIR16",
                                         "RNG19_RFL8_SIG16_NIR16_DUAL",
                                         "RNG15_RFL8_NIR8",
                                         "RNG15_RFL8_NIR8_DUAL",
                                         "FUSA_RNG15_RFL8_NIR8_DUAL"),
                         [](const auto& test) { return std::string(test.param); });

TEST(OusterEncoder, StatesTheTimeOfItsClock) {
  const MadeOuster sensor(MadeOusterMetadataText("RNG15_RFL8_NIR8"));
  const Frame frame = sensor.MakeFrame(0);
  const auto encoder = MakeOusterEncoder(sensor.lidar());
  constexpr std::int64_t kAhead_ns = 123'456'789'000;
  encoder->SetClockAhead(kAhead_ns);
  Datagrams datagrams;
  encoder->Encode(frame, datagrams);
  constexpr std::int64_t kTime0_ns = kSimulationEpoch_s * kNsPerS + kAhead_ns;
  EXPECT_EQ(sensor.Decode(datagrams).at(0).stamp_ns, kTime0_ns + frame.stamp_ns);
  const auto motion =
      std::ranges::find(datagrams.items, DatagramPort::kPosition, &Datagrams::Item::port);
  ASSERT_NE(motion, datagrams.items.end());
  EXPECT_EQ(LoadAt<std::int64_t>(datagrams.BytesOf(*motion).data()), kTime0_ns + motion->due_ns);
}

TEST(OusterEncoder, LeavesOutRangesThatTheProfileCannotState) {
  const MadeOuster sensor(MadeOusterMetadataText("RNG15_RFL8_NIR8"));
  Frame frame = sensor.MakeFrame(0);
  std::ranges::fill(frame.range_m, 262.2F);
  frame.range_m[0] = 262.1F;
  const auto encoder = MakeOusterEncoder(sensor.lidar());
  Datagrams datagrams;
  encoder->Encode(frame, datagrams);
  EXPECT_EQ(sensor.Decode(datagrams).at(0).points.size(), 1U);
}

// Whole groups of 16 columns are sent, of which those outside of the window are marked.
TEST(OusterEncoder, SendsAWindowAsARealSensorDoes) {
  const MadeOuster sensor(MadeOusterMetadataText("RNG15_RFL8_NIR8", 1, 256));
  const Datagrams datagrams = sensor.Encode({0});
  const auto packets = DataPackets(datagrams);
  ASSERT_EQ(packets.size(), 17U);
  const OusterLayout layout(sensor.metadata());
  EXPECT_FALSE(layout.ColumnOf(packets[0], 0).is_valid);
  EXPECT_EQ(layout.ColumnOf(packets[0], 0).measurement_id, 0U);
  EXPECT_TRUE(layout.ColumnOf(packets[0], 1).is_valid);
  EXPECT_TRUE(layout.ColumnOf(packets[16], 0).is_valid);
  for (std::size_t i = 1; i < 16; ++i) EXPECT_FALSE(layout.ColumnOf(packets[16], i).is_valid);
  // The column before the window has the time at which it would have been measured.
  EXPECT_EQ(layout.ColumnOf(packets[0], 1).time_ns - layout.ColumnOf(packets[0], 0).time_ns,
            195'313U);
}

// Frames go from 370 over the end of the turn to 85; those of the sensor end with the turn.
TEST(OusterEncoder, NumbersFramesByTheTurnWhereTheWindowGoesAcrossItsEnd) {
  const MadeOuster sensor(MadeOusterMetadataText("LEGACY", 370, 85));
  const std::vector<SensorTurn> turns = sensor.Decode(sensor.Encode({0, 1}));
  ASSERT_EQ(turns.size(), 3U);
  EXPECT_EQ(turns[0].num_columns(), 142U);
  EXPECT_EQ(turns[1].num_columns(), 86U + 142U);
  EXPECT_EQ(turns[2].num_columns(), 86U);
}

// Columns 0 to 5 end one frame and 10 to 15 begin the next; they share a packet.
TEST(OusterEncoder, CompletesAPacketThatTwoFramesShare) {
  const MadeOuster sensor(MadeOusterMetadataText("RNG15_RFL8_NIR8", 10, 5));
  const OusterLayout layout(sensor.metadata());
  const auto num_valid = [&](std::span<const char> packet) {
    std::size_t num = 0;
    for (std::size_t i = 0; i < 16; ++i) num += layout.ColumnOf(packet, i).is_valid ? 1 : 0;
    return num;
  };
  const Datagrams both = sensor.Encode({0, 1});
  ASSERT_EQ(DataPackets(both).size(), 64U) << "the last one waits for the third frame";
  EXPECT_EQ(num_valid(DataPackets(both)[0]), 6U) << "nothing was before";
  EXPECT_EQ(num_valid(DataPackets(both)[32]), 12U);
  // Without the frame between them, both packets that it had a part in are missing.
  const Datagrams gap = sensor.Encode({0, 2});
  EXPECT_EQ(DataPackets(gap).size(), 32U + 31U);
}

TEST(OusterEncoder, StampsPacketsInOrderAndSendsMotionEvery10Ms) {
  const MadeOuster sensor(MadeOusterMetadataText());
  const Datagrams datagrams = sensor.Encode({0, 1});
  EXPECT_TRUE(std::ranges::is_sorted(datagrams.items, {}, &Datagrams::Item::due_ns));
  std::vector<std::int64_t> times_ns;
  for (const Datagrams::Item& item : datagrams.items) {
    if (item.port == DatagramPort::kPosition) times_ns.push_back(item.due_ns);
  }
  ASSERT_EQ(times_ns.size(), 20U);
  for (std::size_t i = 0; i < times_ns.size(); ++i) {
    EXPECT_EQ(times_ns[i], 10'000'000 * static_cast<std::int64_t>(i));
  }
}

TEST(OusterEncoder, SaysWhatDoesNotFitTheMetadata) {
  EXPECT_EQ(
      MessageOf([] { static_cast<void>(MakeOusterEncoder({})); }),
      "--protocol ouster: /lidar/ouster_metadata: must name the metadata of the sensor, which "
      "its packets follow (got none)");
  const auto fault = [](const char* profile, ReturnMode mode) {
    const MadeOuster sensor((MadeOusterMetadataText(profile)));
    LidarSpec lidar = sensor.lidar();
    lidar.receiver.return_mode = mode;
    return MessageOf([&] { static_cast<void>(MakeOusterEncoder(lidar)); });
  };
  EXPECT_EQ(fault("RNG19_RFL8_SIG16_NIR16", ReturnMode::kDual),
            "--protocol ouster: /lidar/receiver/return_mode: must be \"strongest\", \"first\" or "
            "\"last\" with profile RNG19_RFL8_SIG16_NIR16 (got \"dual\")");
  EXPECT_EQ(fault("RNG19_RFL8_SIG16_NIR16_DUAL", ReturnMode::kLast),
            "--protocol ouster: /lidar/receiver/return_mode: must be \"dual\" with profile "
            "RNG19_RFL8_SIG16_NIR16_DUAL (got \"last\")");
}

// A circle of 100 m at 20 m/s: 0.2 rad/s to the left, 4 m/s^2 towards its centre.
TEST(PoseMotion, OnACircleIsThatOfAnIdealInertialSensor) {
  const auto pose_at = [](std::int64_t time_ns) {
    const double turned_rad = 0.2 * SecondsFromNs(time_ns);
    return MakeTransform(RotationFromYawPitchRoll(turned_rad, 0.0, 0.0),
                         {100.0 * std::sin(turned_rad), -100.0 * std::cos(turned_rad), 3.0});
  };
  Frame frame;
  frame.duration_ns = 100'000'000;
  frame.world_from_sensor = pose_at(0);
  for (const std::uint32_t time_ns : {20'000'000U, 40'000'000U, 60'000'000U, 80'000'000U}) {
    frame.poses_between.push_back({time_ns, pose_at(time_ns)});
  }
  frame.world_from_sensor_end = pose_at(frame.duration_ns);
  const PoseMotion motion(frame, Transform::Identity());
  for (std::int64_t time_ns = 0; time_ns < 100'000'000; time_ns += 10'000'000) {
    const OusterImu imu = motion.At(time_ns);
    EXPECT_NEAR(imu.rotation_degps[2], DegFromRad(0.2), 1e-4);
    EXPECT_NEAR(imu.rotation_degps[0], 0.0, 1e-4);
    // The acceleration is that of the middle pose, up to 20 ms or 0.004 rad away.
    EXPECT_NEAR(imu.acceleration_g[1], 4.0 / 9.80665, 1e-4);
    EXPECT_NEAR(imu.acceleration_g[0], 0.0, 0.004 * 0.41);
    EXPECT_NEAR(imu.acceleration_g[2], 1.0, 1e-6);
  }
}

}  // namespace
}  // namespace railcast
