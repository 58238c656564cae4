#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/extras/packets/spinning/spinning_model.h"
#include "core/extras/packets/velodyne/velodyne_packet.h"
#include "core/io/write_file.h"
#include "core/scenario/sensors.h"
#include "railcast/io/stream.h"
#include "railcast/scenario.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/live/live_process.h"
#include "tests/support/exits_with.h"

namespace railcast {
namespace {

TEST(Stream, SendsTheFramesThatSequenceWrites) {
  const TemporaryDirectory folder;
  const std::string scenario = CoarseScenario(folder.path());
  for (const std::string pacing : {"spread", "burst"}) {
    StreamReceiver receiver(kAnyLoopbackPort);
    Stream stream(scenario + " --duration 0.2 --pacing " + pacing + " --to " +
                  EndpointText(receiver.at()));
    std::vector<ReceivedFrame> frames;
    while (frames.size() < 4) {
      auto frame = receiver.Next(kPatience_ms);
      ASSERT_TRUE(frame.has_value());
      frames.push_back(std::move(*frame));
    }
    EXPECT_THAT(stream.Wait(), ExitsWith(0, testing::HasSubstr("coarse: 4 frames, ")));
    EXPECT_EQ(receiver.counts().stream.lost_packets, 0U);
    const auto out = folder.path() / ("out_" + pacing);
    ASSERT_EQ(Generate("sequence " + scenario + " --frames 4 --out " + out.string()).status, 0);
    for (int i = 0; i < 4; ++i) {
      EXPECT_EQ(frames[static_cast<std::size_t>(i)].header.frame, static_cast<std::uint32_t>(i));
      ExpectSamePoints(frames[static_cast<std::size_t>(i)],
                       out / ("frames/00000" + std::to_string(i) + ".pcd"));
    }
  }
}

TEST(Stream, SendsVelocitiesOfASensorThatMeasuresThem) {
  const TemporaryDirectory folder;
  const std::string scenario = CoarseScenario(folder.path());
  std::string text = ReadFileWhole(scenario);
  const std::string name = R"("name": "coarse",)";
  text.insert(text.find(name), R"("velocity": {"sigma_mps": 0, "max_mps": 50}, )");
  WriteFileWhole(scenario, text);
  StreamReceiver receiver(kAnyLoopbackPort);
  Stream stream(scenario + " --duration 0.05 --to " + EndpointText(receiver.at()));
  const auto frame = receiver.Next(kPatience_ms);
  ASSERT_TRUE(frame.has_value());
  const StreamField* const field = frame->header.Find("radial_velocity_mps");
  ASSERT_NE(field, nullptr);
  EXPECT_EQ(frame->header.Find("true_radial_velocity_mps"), nullptr);
  ASSERT_GT(frame->num_points(), 100U);
  // All stands but the vehicle, at 10 m/s.
  for (std::size_t i = 0; i < frame->num_points(); ++i) {
    EXPECT_LT(frame->At<float>(*field, i), -9.0F);
    EXPECT_GE(frame->At<float>(*field, i), -10.001F);
  }
  EXPECT_EQ(stream.Wait().status, 0);
}

TEST(Stream, WritesTheSameCaptureEachTimeAtAnyThreadCount) {
  const TemporaryDirectory folder;
  const std::string scenario = CoarseScenario(folder.path());
  const auto capture = [&](const std::string& name, const std::string& options) {
    const auto file = folder.path() / name;
    EXPECT_THAT(
        Generate("stream " + scenario + " --duration 1 --pcap " + file.string() + " " + options),
        ExitsWith(0));
    return ReadFileWhole(file);
  };
  const std::string once = capture("a.pcap", "--threads 1");
  EXPECT_GT(once.size(), 20'000U);
  EXPECT_TRUE(once == capture("b.pcap", "--threads 2"));
  EXPECT_FALSE(once == capture("c.pcap", "--seed 9"));
  EXPECT_TRUE(once == capture("d.pcap", "--certify 50%"));
}

TEST(Stream, EndsInOrderOnASignal) {
  const TemporaryDirectory folder;
  const std::string scenario = CoarseScenario(folder.path());
  StreamReceiver receiver(kAnyLoopbackPort);
  const auto pid_file = folder.path() / "pid";
  Stream stream(scenario + " --to " + EndpointText(receiver.at()) + NotedIn(pid_file));
  ASSERT_TRUE(receiver.Next(kPatience_ms).has_value());
  Interrupt(pid_file);
  EXPECT_THAT(stream.Wait(), ExitsWith(0, testing::AllOf(testing::HasSubstr(" late; "),
                                                         testing::HasSubstr("lateness"))));
}

TEST(Stream, SendsSeveralSensorsOfOneVehicleByOneClock) {
  const TemporaryDirectory folder;
  StreamReceiver front(kAnyLoopbackPort);
  StreamReceiver roof(kAnyLoopbackPort);
  const auto lidar = [](const std::string& name, double rate_hz) {
    return R"({"name": ")" + name + R"(", "range_max_m": 100, "mount": {"position_m": [1, 0, 2.5]},
              "scan": {"rate_hz": )" +
           std::to_string(rate_hz) + R"(, "pattern": {"type": "raster",
              "horizontal_fov_deg": 40, "vertical_fov_deg": 20, "angular_resolution_deg": 0.5}}})";
  };
  const auto scenario = folder.path() / "two.json";
  WriteFileWhole(scenario, R"({
    "version": 1,
    "fidelity": "geometry",
    "lidars": [)" + lidar("front", 20) +
                               ", " + lidar("roof", 10) + R"(],
    "interfaces": {"sensors": [{"sensor": "front", "udp": [")" +
                               EndpointText(front.at()) + R"("]},
                               {"sensor": "roof", "udp": [")" +
                               EndpointText(roof.at()) + R"("]}]},
    "world": {
      "alignment": {
        "course": {"type": "elements", "elements": [{"type": "straight", "length_m": 600}]}
      }
    },
    "vehicle": {"start_s_m": 200, "motion": {"profile": [{"time_s": 0, "speed_mps": 10}]}},
    "materials": ")" + kScenariosFolder +
                               R"(materials/railway.json",
    "labels": ")" + kScenariosFolder +
                               R"(labels.json"
  })");
  Stream stream(scenario.string() + " --duration 0.3");
  std::vector<ReceivedFrame> front_frames;
  std::vector<ReceivedFrame> roof_frames;
  while (front_frames.size() < 6) front_frames.push_back(front.Next(kPatience_ms).value());
  while (roof_frames.size() < 3) roof_frames.push_back(roof.Next(kPatience_ms).value());
  EXPECT_THAT(stream.Wait(), ExitsWith(0, testing::AllOf(testing::HasSubstr("front: 6 frames, "),
                                                         testing::HasSubstr("roof: 3 frames, "))));
  for (std::size_t i = 0; i < roof_frames.size(); ++i) {
    // Both sensors have the same mounting, so at the same time they have the same pose.
    const StreamHeader& a = front_frames[2 * i].header;
    const StreamHeader& b = roof_frames[i].header;
    EXPECT_EQ(a.stamp_ns, b.stamp_ns);
    EXPECT_EQ(a.world_from_sensor.matrix(), b.world_from_sensor.matrix());
    EXPECT_EQ(a.sensor, 0);
    EXPECT_EQ(b.sensor, 1);
  }
}

TEST(Stream, KnowsTheProtocolsAndPortsThatScenariosName) {
  EXPECT_EQ(DefaultPort(Protocol::kRailcast), kStreamPort);
  EXPECT_EQ(DefaultPort(Protocol::kOuster), kOusterLidarPort);
  EXPECT_EQ(PositionPort(Protocol::kOuster), kOusterImuPort);
  for (const auto& [protocol, name] : kEnumNames<Protocol>) {
    const bool has_own_ports = protocol == Protocol::kRailcast || protocol == Protocol::kOuster ||
                               protocol == Protocol::kRos2;
    if (has_own_ports) continue;
    const SpinningModel& model = *FindSpinningModel(name);
    EXPECT_EQ(model.protocol, name);
    EXPECT_EQ(DefaultPort(protocol), kVelodyneDataPort);
    EXPECT_EQ(PositionPort(protocol).has_value(), model.date_place == 0);
  }
}

TEST(Stream, SaysWhichOptionsDoNotGoTogether) {
  const TemporaryDirectory folder;
  const std::string scenario = CoarseScenario(folder.path());
  const std::string two_sensors = kScenariosFolder + "two_sensors.json";
  const auto fault = [](const std::string& arguments) {
    const Ended ended = Generate("stream " + arguments);
    EXPECT_EQ(ended.status, 1);
    return ended.said;
  };
  EXPECT_EQ(
      fault(scenario + " --lockstep"),
      "--lockstep: needs --commands-port or --step-topic, where steps are heard (got none)\n");
  EXPECT_EQ(fault(scenario + " --step-topic /step"),
            "--step-topic: needs --lockstep, with which frames wait for steps (got none)\n");
  EXPECT_EQ(fault(scenario + " --lockstep --step-topic /step"),
            "--step-topic: is for protocol ros2 (got railcast)\n");
  EXPECT_EQ(fault(scenario + " --commands-log a"),
            "--commands-log: needs --commands-port, where commands are heard (got none)\n");
  EXPECT_EQ(fault(scenario + " --pcap a"),
            "--pcap: needs --duration where no --to is given (got none)\n");
  EXPECT_EQ(fault(scenario + " --drop-late --lockstep --commands-port 9"),
            "--drop-late: must be left out where frames wait for steps, as with --lockstep\n");
  EXPECT_EQ(fault(scenario + " --fail-late --pcap a --duration 1"),
            "--fail-late: must be left out where frames are never late, as with --pcap without "
            "--to\n");
  EXPECT_EQ(fault(scenario + " --duration 1 --summary " + folder.path().string()),
            folder.path().string() + ": must be a regular file (got a directory)\n");
  EXPECT_EQ(fault(scenario + " --no-offload --pcap a --duration 1"),
            "--no-offload: must be left out where nothing is sent, as with --pcap without --to\n");
  EXPECT_EQ(fault(scenario + " --drop-late --pcap a --duration 1"),
            "--drop-late: must be left out where frames are never late, as with --pcap without "
            "--to\n");
  EXPECT_EQ(fault(two_sensors + " --to :1000"),
            "--to: is for one sensor, to be named by --sensor (got 2 sensors)\n");
  EXPECT_EQ(fault(scenario + " --to 10.0.0.1:0"),
            "--to: the port must be a whole number from 1 to 65535 (got 10.0.0.1:0)\n");
  EXPECT_EQ(fault(scenario + " --to 010.0.0.1"),
            "--to: a numeric address must be four numbers from 0 to 255 with dots between, none "
            "with a leading 0 (got 010.0.0.1)\n");
  EXPECT_EQ(
      fault(scenario + " --to 127.255.255.255:9"),
      "receivers of coarse: must not be a network's broadcast address; use 255.255.255.255 (got "
      "127.255.255.255:9)\n");
  EXPECT_EQ(fault(scenario + " --protocol vlp16 --to 127.0.0.1:8308"),
            "receivers of coarse: must not be where coarse sends position packets (got "
            "127.0.0.1:8308)\n");
  EXPECT_NE(fault(scenario + " --protocol vlp16").find("must be \"spinning\""), std::string::npos);
  EXPECT_EQ(fault(scenario + " --protocol vlp16 --fields x"),
            "--fields: is for protocol railcast (got vlp16)\n");
  EXPECT_EQ(fault(scenario + " --protocol hdl32e --all-slots"),
            "--all-slots: is for protocol railcast (got hdl32e)\n");
  EXPECT_EQ(fault(scenario + " --calibration a"),
            "--calibration: is for one sensor of protocol hdl64e (got railcast)\n");
}

}  // namespace
}  // namespace railcast
