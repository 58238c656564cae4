#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <future>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/extras/packets/pcap/pcap_reader.h"
#include "core/io/net/udp.h"
#include "core/io/write_file.h"
#include "core/scenario/sensors.h"
#include "tests/core/io/recording/read_all.h"
#include "tests/core/io/stream/listening_program.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/live/live_process.h"
#include "tests/support/exits_with.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

/// A running `railcast-generate replay`.
std::future<Ended> Replaying(const std::string& arguments) {
  return std::async(std::launch::async,
                    [arguments] { return GenerateLive("replay " + arguments); });
}

/// The coarse scenario, or another sensor before its wagon, in the sensor's axes.
std::string ReplayedScenario(const fs::path& folder, const std::string& sensor = "") {
  const fs::path file = folder / ("sensor" + sensor + ".json");
  const std::string lidar =
      sensor.empty() ? ""
                     : R"(, "lidar": ")" + kScenariosFolder + "sensors/" + sensor + R"(.json")";
  WriteFileWhole(file, R"({"version": 1, "file": ")" + CoarseScenario(folder) +
                           R"(", "fidelity": "plausibility", "output": {"frame": "sensor"})" +
                           lidar + "}");
  return file.string();
}

/// Makes a sequence of a scenario and returns its directory.
fs::path MadeRun(const std::string& scenario, const fs::path& out, const std::string& options) {
  EXPECT_THAT(Generate("sequence " + scenario + " --out " + out.string() + " " + options),
              ExitsWith(0));
  return out;
}

using Payload = std::vector<char>;

std::vector<Payload> Receive(UdpReceiver& receiver, std::size_t num) {
  std::vector<Payload> payloads;
  while (payloads.size() < num) {
    const auto received = receiver.Receive(kPatience_ms);
    if (!received) break;
    payloads.emplace_back(received->bytes.begin(), received->bytes.end());
  }
  return payloads;
}

/// The payloads that a capture has at a port.
std::vector<Payload> PayloadsTo(const fs::path& capture, std::uint16_t port) {
  std::vector<Payload> payloads;
  PcapReader reader(capture);
  while (const auto datagram = reader.Next()) {
    if (datagram->destination_port != port) continue;
    payloads.emplace_back(datagram->payload.begin(), datagram->payload.end());
  }
  return payloads;
}

TEST(ReplayCommand, SendsTheFramesOfASequence) {
  const TemporaryDirectory folder;
  const fs::path run =
      MadeRun(ReplayedScenario(folder.path()), folder.path() / "run", "--frames 4");
  StreamReceiver receiver(kAnyLoopbackPort);
  const std::string at = EndpointText(receiver.at());
  auto replay = Replaying(run.string() + " --rate 2 --to " + at);
  const auto frames = ReadAll(run);
  ASSERT_EQ(frames.size(), 4U);
  for (std::uint32_t i = 0; i < 4; ++i) {
    const auto received = receiver.Next(kPatience_ms);
    ASSERT_TRUE(received);
    const StreamHeader& header = received->header;
    EXPECT_EQ(header.frame, i);
    EXPECT_EQ(header.stamp_ns, frames[i].frame.stamp_ns);
    EXPECT_EQ(header.duration_ns, frames[i].frame.duration_ns);
    EXPECT_TRUE(header.world_from_sensor.isApprox(frames[i].frame.world_from_sensor, 1e-12));
    EXPECT_TRUE(
        header.world_from_sensor_end.isApprox(frames[i].frame.world_from_sensor_end, 1e-12));
    EXPECT_EQ(header.fields.size(), 8U);
    ExpectSamePoints(*received, run / ("frames/00000" + std::to_string(i) + ".pcd"));
  }
  EXPECT_THAT(replay.get(),
              ExitsWith(0, testing::AllOf(testing::StartsWith("coarse: railcast to " + at + "\n"),
                                          testing::HasSubstr("coarse: 4 frames, "))));
}

class ReplayedCapture : public testing::TestWithParam<const char*> {};

TEST_P(ReplayedCapture, ArrivesByteForByteAtItsPortsAtItsPace) {
  const fs::path capture = fs::path(RAILCAST_SHARED_DATA_DIR) / GetParam();
  if (!exists(capture)) GTEST_SKIP() << capture << " is not there";
  Endpoint here = OwnEndpoint();
  const bool is_ouster = capture.string().find("ouster") != std::string::npos;
  here.port = is_ouster ? kOusterLidarPort : kVelodyneDataPort;
  UdpReceiver packets(here);
  here.port = is_ouster ? kOusterImuPort : kVelodynePositionPort;
  UdpReceiver reports(here);
  const auto begin = std::chrono::steady_clock::now();
  const std::string host = EndpointText(here).substr(0, EndpointText(here).find(':'));
  auto replay = Replaying(capture.string() + " --rate 2 --to " + host);
  const auto expected = PayloadsTo(capture, packets.at().port);
  EXPECT_TRUE(Receive(packets, expected.size()) == expected);
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
  const auto expected_reports = PayloadsTo(capture, reports.at().port);
  EXPECT_TRUE(Receive(reports, expected_reports.size()) == expected_reports);
  EXPECT_THAT(replay.get(), ExitsWith(0));
  // Each of them holds 0.29 s of data at least.
  EXPECT_GT(elapsed.count(), 0.29 / 2);
}

INSTANTIATE_TEST_SUITE_P(Real,
                         ReplayedCapture,
                         testing::Values("lidar_packets_nebula/vlp16_dual.pcap",
                                         "lidar_packets_nebula/pandar64.pcap",
                                         "lidar_ouster/OS-1-128_v2.3.0_1024x10_lb_n3.pcap"),
                         [](const auto& test) { return "Number" + std::to_string(test.index); });

TEST(ReplayCommand, SendsTheRealPacketsOfABag) {
  const fs::path bag = fs::path(RAILCAST_SHARED_DATA_DIR) / "lidar_hesai/captures/xt32.db3";
  if (!exists(bag)) GTEST_SKIP() << bag << " is not there";
  UdpReceiver receiver(kAnyLoopbackPort);
  auto replay =
      Replaying(bag.string() + " --protocol packets --rate 4 --to " + EndpointText(receiver.at()));
  constexpr std::size_t kPacketSize = 1080;
  for (const Payload& payload : Receive(receiver, 100)) EXPECT_EQ(payload.size(), kPacketSize);
  EXPECT_THAT(replay.get(), ExitsWith(0, testing::StartsWith("XT32: packets to " +
                                                             EndpointText(receiver.at()) + "\n")));
}

class ReplayedPackets : public testing::TestWithParam<const char*> {};

TEST_P(ReplayedPackets, OfASequenceAreThoseThatStreamSends) {
  const std::string protocol = GetParam();
  const TemporaryDirectory folder;
  const std::string scenario = ReplayedScenario(folder.path(), protocol);
  const fs::path capture = folder.path() / "stream.pcap";
  ASSERT_THAT(Generate("stream " + scenario + " --protocol " + protocol +
                       " --duration 0.2 --pcap " + capture.string()),
              ExitsWith(0));
  const fs::path run = MadeRun(scenario, folder.path() / "run", "--frames 2");
  UdpReceiver receiver(kAnyLoopbackPort);
  auto replay =
      Replaying(run.string() + " --protocol " + protocol + " --to " + EndpointText(receiver.at()));
  const auto expected = PayloadsTo(capture, kVelodyneDataPort);
  EXPECT_GT(expected.size(), 100U);
  EXPECT_TRUE(Receive(receiver, expected.size()) == expected);
  EXPECT_EQ(replay.get().status, 0);
}

INSTANTIATE_TEST_SUITE_P(Sensors,
                         ReplayedPackets,
                         testing::Values("vlp16", "xt16", "pandar128e4x"),
                         [](const auto& test) { return std::string(test.param); });

TEST(ReplayCommand, LetsFramesWaitForSteps) {
  const TemporaryDirectory folder;
  const fs::path run =
      MadeRun(ReplayedScenario(folder.path()), folder.path() / "run", "--frames 3");
  StreamReceiver receiver(kAnyLoopbackPort);
  const std::string port = FreePort();
  auto replay = Replaying(run.string() + " --lockstep --commands-port " + port + " --pacing burst" +
                          " --start-frame 1 --to " + EndpointText(receiver.at()));
  Controller controller(port);
  EXPECT_THAT(controller.Say(R"({"command":"brake"})"),
              testing::HasSubstr("command: must be step, since a replay is as it was recorded (got "
                                 "brake)"));
  EXPECT_FALSE(receiver.Next(100));
  for (std::uint32_t i = 1; i < 3; ++i) {
    EXPECT_THAT(controller.Say(R"({"command":"step"})"), testing::HasSubstr(R"("ok":true)"));
    const auto received = receiver.Next(kPatience_ms);
    ASSERT_TRUE(received);
    EXPECT_EQ(received->header.frame, i);
  }
  EXPECT_EQ(replay.get().status, 0);
}

TEST(ReplayCommand, StatesTheTimeOfDayIfToldSo) {
  const TemporaryDirectory folder;
  const fs::path run =
      MadeRun(ReplayedScenario(folder.path()), folder.path() / "run", "--frames 1");
  StreamReceiver receiver(kAnyLoopbackPort);
  auto replay = Replaying(run.string() + " --clock utc --to " + EndpointText(receiver.at()));
  const auto received = receiver.Next(kPatience_ms);
  ASSERT_TRUE(received);
  // Nothing leaves before its time; a busy machine may send it late, but not minutes later.
  EXPECT_GE(received->first_arrival_ns, received->header.stamp_ns);
  EXPECT_GE(received->last_arrival_ns, received->first_arrival_ns);
  EXPECT_LT(received->last_arrival_ns, received->header.stamp_ns + 60'000'000'000);
  EXPECT_EQ(replay.get().status, 0);
}

TEST(ReplayCommand, WritesItsSummaryAndWhatWasDamaged) {
  const TemporaryDirectory folder;
  const fs::path run =
      MadeRun(ReplayedScenario(folder.path()), folder.path() / "run", "--frames 3");
  fs::resize_file(run / "frames/000002.pcd", 1'000);
  const fs::path summary = folder.path() / "summary.json";
  EXPECT_THAT(
      Generate("replay " + run.string() + " --rate 10 --to 127.0.0.1:9 --summary " +
               summary.string()),
      ExitsWith(1, testing::AllOf(
                       testing::HasSubstr("coarse: 2 frames, "),
                       testing::HasSubstr("\n" + (run / "frames/000002.pcd").string() + ": "))));
  const auto json = nlohmann::json::parse(ReadFileWhole(summary));
  EXPECT_EQ(json.at("command"), "replay");
  EXPECT_EQ(json.at("sensors").at(0).at("frames"), 2);
  EXPECT_THAT(json.at("fault").get<std::string>(), testing::HasSubstr("000002.pcd"));
}

TEST(ReplayCommand, WritesNoSummaryIntoTheRecording) {
  const TemporaryDirectory folder;
  const fs::path run =
      MadeRun(ReplayedScenario(folder.path()), fs::canonical(folder.path()) / "run", "--frames 1");
  const std::string summary = (run / "run.json").string();
  EXPECT_THAT(Generate("replay " + run.string() + " --to 127.0.0.1:9 --summary " + summary),
              ExitsWith(1, "--summary: must be outside " + run.string() +
                               ", which holds nothing but what belongs to its frames.jsonl (got " +
                               summary + ")\n"));
}

TEST(ReplayCommand, EndsInOrderOnASignal) {
  const TemporaryDirectory folder;
  const fs::path run =
      MadeRun(ReplayedScenario(folder.path()), folder.path() / "run", "--frames 4");
  StreamReceiver receiver(kAnyLoopbackPort);
  const fs::path pid_file = folder.path() / "pid";
  auto replay = Replaying(run.string() + " --rate 0.05 --pacing burst --to " +
                          EndpointText(receiver.at()) + NotedIn(pid_file));
  ASSERT_TRUE(receiver.Next(kPatience_ms));
  Interrupt(pid_file);
  EXPECT_THAT(replay.get(), ExitsWith(0, testing::HasSubstr(" late; ")));
}

TEST(ReplayCommand, SaysWhatDoesNotGoTogether) {
  const TemporaryDirectory folder;
  const fs::path run = MadeRun(ReplayedScenario(folder.path()), folder.path() / "run",
                               "--frames 1 --fields x,y,z,intensity,time_ns");
  const fs::path cloud = run / "frames/000000.pcd";
  const auto fault = [](const std::string& arguments) {
    const Ended ended = Generate("replay " + arguments);
    EXPECT_EQ(ended.status, 1) << arguments;
    return ended.said;
  };
  EXPECT_EQ(fault(run.string() + " --protocol packets"),
            run.string() +
                ": must be a capture or a bag with a sensor's packets if --protocol is packets "
                "(got neither); --protocol railcast and ros2 send frames\n");
  EXPECT_EQ(fault(cloud.string() + " --protocol vlp16"),
            "--protocol vlp16: is for sequences of railcast, whose scenarios say how the sensor "
            "fires; must be railcast or ros2 here (got point cloud file)\n");
  EXPECT_EQ(
      fault(run.string() + " --protocol vlp16"),
      "--protocol vlp16: needs every firing of a frame with range_m, intensity, power_ratio, "
      "time_ns, outcome and true_range_m, as `sequence --format pcd --fields all` writes them "
      "(got none of power_ratio)\n");
  EXPECT_THAT(fault(run.string() + " --fields x,label"),
              testing::StartsWith("--fields: must be among those of the recording, x,y,z,"));
  EXPECT_EQ(fault(run.string() + " --topic /points"),
            "--topic: must come with a bag of ROS 2, .mcap, .db3 or a directory of them (got " +
                run.string() + ")\n");
  EXPECT_EQ(fault(run.string() + " --sensor 10.0.0.1"),
            "--sensor: must come with a capture, .pcap or .pcapng (got " + run.string() + ")\n");
  const fs::path bag = folder.path() / "a.mcap";
  WriteFileWhole(bag, "");
  EXPECT_EQ(fault(bag.string() + " --sensor 10.0.0.1"),
            "--sensor: is for captures, since bags do not say who sent packets\n");
  EXPECT_EQ(fault(run.string() + " --domain 3"), "--domain: is for protocol ros2\n");
  EXPECT_EQ(
      fault(run.string() + " --protocol ros2 --to :9"),
      "--to: must be left out with protocol ros2, which sends messages to whoever reads their "
      "topics\n");
  EXPECT_EQ(fault("a.pcap --rate-hz 10"),
            "--rate-hz: is for frames, with --protocol railcast or another that is not as "
            "recorded\n");
  EXPECT_EQ(fault(run.string() + " --clock utc --rate 2"),
            "--clock utc: must be left out where frames take another time than recorded, as with "
            "--rate and --lockstep\n");
  EXPECT_EQ(fault(run.string() + " --lockstep"),
            "--lockstep: needs --commands-port, where commands are heard (got none)\n");
  EXPECT_EQ(fault(run.string() + " --commands-port 9"),
            "--commands-port: needs --lockstep, since a replay hears `step` alone\n");
  EXPECT_EQ(fault(run.string() + " --start-frame 1"),
            "--start-frame: must be the number of a frame of " + run.string() + " (got 1)\n");
  EXPECT_EQ(fault((folder.path() / "no.pcap").string()),
            (folder.path() / "no.pcap").string() + ": no such file or directory\n");
  EXPECT_EQ(Generate("replay " + run.string() + " --rate 0").status, 2);
}

}  // namespace
}  // namespace railcast
