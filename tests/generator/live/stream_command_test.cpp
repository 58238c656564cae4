#include <gtest/gtest.h>
#include <signal.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <future>
#include <limits>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "core/io/net/udp_receiver.h"
#include "core/io/pcd_reader.h"
#include "core/io/stream/stream_receiver.h"
#include "core/io/write_file.h"
#include "core/scenario/scenario.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/project_folder.h"
#include "tests/generator/run_command.h"

namespace railcast {
namespace {

constexpr Endpoint kAnyLoopbackPort{0x7F000001, 0};
constexpr int kPatience_ms = 20'000;

// A coarse scan at 20 Hz of a wagon 40 m ahead of a vehicle at 10 m/s, in vehicle axes.
std::string CoarseScenario(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "coarse.json";
  WriteFileWhole(file, R"({
    "version": 1,
    "fidelity": "surface",
    "lidar": {"name": "coarse", "range_max_m": 100, "mount": {"position_m": [1, 0, 2.5]},
              "scan": {"rate_hz": 20, "pattern": {"type": "raster", "horizontal_fov_deg": 40,
                       "vertical_fov_deg": 20, "angular_resolution_deg": 0.5}}},
    "world": {
      "alignment": {
        "course": {"type": "elements", "elements": [{"type": "straight", "length_m": 600}]}
      },
      "catenary": {"enabled": false},
      "vegetation": {"trees_per_hectare": 0, "grass": false},
      "objects": [{"name": "wagon", "type": "open_wagon", "s_m": 250}]
    },
    "vehicle": {"start_s_m": 200, "motion": {"profile": [{"time_s": 0, "speed_mps": 10}]}},
    "output": {"frame": "vehicle"},
    "materials": ")" + scenarios_folder +
                           R"(materials/railway.json",
    "labels": ")" + scenarios_folder +
                           R"(labels.json"
  })");
  return file.string();
}

/// A port that is free now, and was given to nobody just before.
std::string FreePort() {
  return std::to_string(UdpReceiver(kAnyLoopbackPort).at().port);
}

/// `railcast-generate stream` while it runs.
class Stream {
 public:
  explicit Stream(const std::string& arguments)
      : run_(std::async(std::launch::async,
                        [arguments] { return Generate("stream " + arguments); })) {}

  [[nodiscard]] Ended Wait() { return run_.get(); }

 private:
  std::future<Ended> run_;
};

/// Who drives a vehicle in lockstep.
class Controller {
 public:
  explicit Controller(const std::string& port) : to_(ParseEndpoint("127.0.0.1:" + port, 1)) {}

  /// Says a command until it is answered, and gives the answer; empty if there is none.
  std::string Say(const std::string& command) {
    const std::string id = "\"id\":" + std::to_string(++id_) + ",";
    for (int attempt = 0; attempt < 200; ++attempt) {
      port_.Answer("{" + id + command.substr(1), to_);
      const auto answer = port_.Receive(100);
      if (!answer) continue;
      const std::string text(answer->bytes.begin(), answer->bytes.end());
      if (text.find(id) != std::string::npos) return text;
    }
    return "";
  }

 private:
  UdpReceiver port_{kAnyLoopbackPort};
  Endpoint to_;
  int id_ = 0;
};

/// The returned points' x, y, z of a PCD frame that are in the received one, and only they.
void ExpectSamePoints(const ReceivedFrame& received, const std::filesystem::path& pcd_file) {
  const pcl::PCLPointCloud2 cloud = ReadPcd(pcd_file);
  ASSERT_TRUE(received.is_complete());
  const auto value_of = [&](const std::string& name, std::size_t i) {
    for (const auto& field : cloud.fields) {
      if (field.name != name) continue;
      float value = 0;
      std::memcpy(&value, &cloud.data[i * cloud.point_step + field.offset], sizeof value);
      return value;
    }
    return std::numeric_limits<float>::quiet_NaN();
  };
  std::multiset<std::vector<float>> expected;
  for (std::size_t i = 0; i < std::size_t{cloud.width} * cloud.height; ++i) {
    if (std::isnan(value_of("x", i))) continue;
    expected.insert(
        {value_of("x", i), value_of("y", i), value_of("z", i), value_of("intensity", i)});
  }
  std::multiset<std::vector<float>> got;
  for (std::size_t i = 0; i < received.num_points(); ++i) {
    std::vector<float> point;
    for (const char* name : {"x", "y", "z", "intensity"}) {
      point.push_back(received.At<float>(*received.header.Find(name), i));
    }
    got.insert(point);
  }
  EXPECT_GT(got.size(), 100U);
  EXPECT_EQ(got, expected);
}

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
    const Ended ended = stream.Wait();
    EXPECT_EQ(ended.status, 0) << ended.said;
    EXPECT_NE(ended.said.find("coarse: 4 frames, "), std::string::npos) << ended.said;
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

TEST(Stream, WritesTheSameCaptureEachTimeAtAnyThreadCount) {
  const TemporaryDirectory folder;
  const std::string scenario = CoarseScenario(folder.path());
  const auto capture = [&](const std::string& name, const std::string& options) {
    const auto file = folder.path() / name;
    const Ended ended =
        Generate("stream " + scenario + " --duration 1 --pcap " + file.string() + " " + options);
    EXPECT_EQ(ended.status, 0) << ended.said;
    return ReadFileWhole(file);
  };
  const std::string once = capture("a.pcap", "--threads 1");
  EXPECT_GT(once.size(), 20'000U);
  EXPECT_TRUE(once == capture("b.pcap", "--threads 2"));
  EXPECT_FALSE(once == capture("c.pcap", "--seed 9"));
}

TEST(Stream, EndsInOrderOnASignal) {
  const TemporaryDirectory folder;
  const std::string scenario = CoarseScenario(folder.path());
  StreamReceiver receiver(kAnyLoopbackPort);
  const auto pid_file = folder.path() / "pid";
  Stream stream(scenario + " --to " + EndpointText(receiver.at()) + " & echo $! > " +
                pid_file.string() + "; wait $!; exit $?");
  ASSERT_TRUE(receiver.Next(kPatience_ms).has_value());
  ::kill(std::stoi(ReadFileWhole(pid_file)), SIGINT);
  const Ended ended = stream.Wait();
  EXPECT_EQ(ended.status, 0) << ended.said;
  EXPECT_NE(ended.said.find(" late; "), std::string::npos) << ended.said;
  EXPECT_NE(ended.said.find("lateness"), std::string::npos) << ended.said;
}

TEST(Stream, SaysWhyItEndsWhereTheTrackDoes) {
  const TemporaryDirectory folder;
  const std::string scenario = CoarseScenario(folder.path());
  const auto capture = folder.path() / "a.pcap";
  // 400 m at 10 m/s.
  const Ended ended = Generate("stream " + scenario + " --duration 60 --pcap " + capture.string());
  EXPECT_EQ(ended.status, 1);
  EXPECT_NE(ended.said.find("coarse: 800 frames"), std::string::npos) << ended.said;
  EXPECT_NE(ended.said.find("leaves track \"main\""), std::string::npos) << ended.said;
  EXPECT_TRUE(std::filesystem::exists(capture));
}

TEST(Stream, InLockstepMakesWhatSequenceMakesOfItsLog) {
  const TemporaryDirectory folder;
  const std::string scenario = CoarseScenario(folder.path());
  const std::string log = (folder.path() / "log.jsonl").string();
  const std::string commands_port = FreePort();
  StreamReceiver receiver(kAnyLoopbackPort);
  Stream stream(scenario + " --lockstep --duration 0.4 --to " + EndpointText(receiver.at()) +
                " --commands-port " + commands_port + " --commands-log " + log);
  Controller controller(commands_port);
  std::vector<ReceivedFrame> frames;
  const auto step = [&] {
    EXPECT_NE(controller.Say("{\"command\":\"step\"}").find("\"ok\":true"), std::string::npos);
    auto frame = receiver.Next(kPatience_ms);
    ASSERT_TRUE(frame.has_value());
    frames.push_back(std::move(*frame));
  };
  const auto change = [&](const std::string& command) {
    const std::string answer = controller.Say(command);
    EXPECT_NE(answer.find("\"ok\":true"), std::string::npos) << answer;
  };
  step();
  change(R"({"command":"brake","deceleration_mps2":2})");
  step();
  step();
  change(R"({"command":"place_object","object":{"name":"p","type":"person","s_m":220,"d_m":1}})");
  step();
  change(R"({"command":"set_weather","weather":{"rain_rate_mmph":20}})");
  step();
  change(R"({"command":"remove_object","name":"wagon"})");
  EXPECT_NE(controller.Say(R"({"command":"remove_object","name":"wagon"})").find("\"ok\":false"),
            std::string::npos);
  step();
  change(R"({"command":"set_speed","speed_mps":12})");
  step();
  step();
  const Ended ended = stream.Wait();
  EXPECT_EQ(ended.status, 0) << ended.said;
  ASSERT_EQ(frames.size(), 8U);
  const auto out = folder.path() / "out";
  const Ended replay =
      Generate("sequence " + scenario + " --frames 8 --commands " + log + " --out " + out.string());
  ASSERT_EQ(replay.status, 0) << replay.said;
  for (std::size_t i = 0; i < 8; ++i) {
    ExpectSamePoints(frames[i], out / ("frames/00000" + std::to_string(i) + ".pcd"));
  }
}

TEST(Stream, BeginsAnewOnReset) {
  const TemporaryDirectory folder;
  const std::string scenario = CoarseScenario(folder.path());
  const std::string commands_port = FreePort();
  StreamReceiver receiver(kAnyLoopbackPort);
  Stream stream(scenario + " --lockstep --duration 0.15 --to " + EndpointText(receiver.at()) +
                " --commands-port " + commands_port);
  Controller controller(commands_port);
  const auto step = [&] {
    EXPECT_NE(controller.Say("{\"command\":\"step\"}"), "");
    return receiver.Next(kPatience_ms).value();
  };
  const ReceivedFrame first = step();
  EXPECT_NE(controller.Say(R"({"command":"stop"})").find("\"ok\":true"), std::string::npos);
  const ReceivedFrame second = step();
  EXPECT_NE(controller.Say(R"({"command":"reset"})").find("\"ok\":true"), std::string::npos);
  const ReceivedFrame again = step();
  EXPECT_EQ(second.header.frame, 1U);
  EXPECT_EQ(again.header.frame, 0U);
  EXPECT_EQ(again.header.run, first.header.run + 1);
  EXPECT_EQ(again.points, first.points);
  step();
  step();
  EXPECT_EQ(stream.Wait().status, 0);
}

TEST(Stream, IsDrivenByTheClientThatBrakes) {
  const TemporaryDirectory folder;
  const std::string scenario = CoarseScenario(folder.path());
  const std::string commands_port = FreePort();
  const std::string stream_port = FreePort();
  Stream stream(scenario + " --lockstep --duration 20 --fields x,y,z --pacing burst --to :" +
                stream_port + " --commands-port " + commands_port + " & pid=$!; " +
                RAILCAST_SOURCE_DIR "/scripts/brake_client.py --lockstep --front 0 --resolution 0.5 " +
                "--deceleration 2 --stream 127.0.0.1:" + stream_port + " --commands 127.0.0.1:" +
                commands_port + "; status=$?; kill -INT $pid; wait $pid; exit $status");
  const Ended ended = stream.Wait();
  EXPECT_EQ(ended.status, 0) << ended.said;
  // From 10 m/s at 2 m/s^2: 25 m; the brake begins one frame, 0.5 m, after the last one seen.
  EXPECT_NE(ended.said.find("with 10.00 m/s, braking distance 25.5 m, gap left "),
            std::string::npos)
      << ended.said;
}

TEST(Stream, SaysWhichOptionsDoNotGoTogether) {
  const TemporaryDirectory folder;
  const std::string scenario = CoarseScenario(folder.path());
  const std::string two_sensors = scenarios_folder + "two_sensors.json";
  const auto fault = [](const std::string& arguments) {
    const Ended ended = Generate("stream " + arguments);
    EXPECT_EQ(ended.status, 1);
    return ended.said;
  };
  EXPECT_EQ(fault(scenario + " --lockstep"),
            "--lockstep: needs --commands-port, where commands are heard (got none)\n");
  EXPECT_EQ(fault(scenario + " --commands-log a"),
            "--commands-log: needs --commands-port, where commands are heard (got none)\n");
  EXPECT_EQ(fault(scenario + " --pcap a"),
            "--pcap: needs --duration where nobody receives, --to (got none)\n");
  EXPECT_EQ(fault(two_sensors + " --to :1000"),
            "--to: is for one sensor, to be named by --sensor (got 2 sensors)\n");
  EXPECT_EQ(fault(scenario + " --to 10.0.0.1:0"),
            "--to: the port must be a whole number from 1 to 65535 (got 10.0.0.1:0)\n");
  EXPECT_EQ(
      fault(scenario + " --to 127.255.255.255:9"),
      "receivers of coarse: must be no network's broadcast address; 255.255.255.255 is one (got "
      "127.255.255.255:9)\n");
  EXPECT_NE(fault(scenario + " --protocol vlp16").find("must be \"spinning\""), std::string::npos);
  EXPECT_EQ(fault(scenario + " --calibration a"),
            "--calibration: is for one sensor of protocol hdl64e (got railcast)\n");
}

}  // namespace
}  // namespace railcast
