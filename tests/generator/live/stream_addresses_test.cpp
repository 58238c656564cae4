// Where live frames go: by IPv6, to multicast groups, and to several receivers at once.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include "core/extras/packets/spinning/spinning_decoder.h"
#include "core/extras/packets/velodyne/velodyne_packet.h"
#include "railcast/io/stream.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/live/live_process.h"
#include "tests/support/decode_packet.h"
#include "tests/support/loopback.h"

namespace railcast {
namespace {

/// The wagon of CoarseScenario() before sensors of these protocols, each with its receivers.
std::string ScenarioOfSensors(const std::filesystem::path& folder,
                              const std::vector<std::pair<std::string, std::string>>& sensors) {
  std::string lidars, interfaces;
  for (const auto& [protocol, receivers] : sensors) {
    const std::string separator = lidars.empty() ? "" : ", ";
    lidars += separator + R"({"file": ")" + kScenariosFolder + "sensors/" +
              (protocol == "railcast" ? "vir2rail" : protocol) + R"(.json", "name": ")" + protocol +
              "\"}";
    interfaces += separator + R"({"sensor": ")" + protocol + R"(", "protocol": ")" + protocol +
                  R"(", "udp": [)" + receivers + "]}";
  }
  std::string text = ReadFileWhole(CoarseScenario(folder));
  const std::size_t begin = text.find("\"lidar\":");
  text.replace(
      begin, text.find("\"world\":") - begin,
      "\"lidars\": [" + lidars + "], \"interfaces\": {\"sensors\": [" + interfaces + "]}, ");
  const std::string vehicle_axes = R"({"frame": "vehicle"})";
  text.replace(text.find(vehicle_axes), vehicle_axes.size(), R"({"frame": "sensor"})");
  const std::filesystem::path file = folder / "sensors.json";
  WriteFileWhole(file, text);
  return file.string();
}

std::string Quote(const Endpoint& endpoint) {
  return "\"" + EndpointText(endpoint) + "\"";
}

// A sensor by IPv6, one to a group and a single host, and one by IPv4.
TEST(StreamAddresses, MayDifferFromSensorToSensor) {
  const auto ipv6 = AnyIpv6LoopbackPort();
  if (!ipv6) GTEST_SKIP() << "this machine has no IPv6 at ::1";
  const TemporaryDirectory folder;
  StreamReceiver front(*ipv6);
  UdpReceiver group({ParseEndpoint("239.255.23.70%lo", 1).address, 0});
  UdpReceiver host(*ipv6);
  UdpReceiver side(kAnyLoopbackPort);
  const std::string scenario =
      ScenarioOfSensors(folder.path(), {{"railcast", Quote(front.at())},
                                        {"vlp16", Quote(group.at()) + ", " + Quote(host.at())},
                                        {"xt16", Quote(side.at())}});
  Stream stream(scenario + " --duration 0.2 --multicast-hops 2");
  EXPECT_TRUE(front.Next(kPatience_ms).value().is_complete());
  SpinningDecoder xt16(*FindSpinningModel("xt16"));
  std::vector<SensorTurn> turns;
  for (int i = 0; i < 70; ++i) {
    const auto from_group = group.Receive(kPatience_ms);
    ASSERT_TRUE(from_group.has_value());
    const std::string bytes(from_group->bytes.begin(), from_group->bytes.end());
    EXPECT_EQ(bytes.size(), 1206U);
    const auto from_host = host.Receive(kPatience_ms);
    ASSERT_TRUE(from_host.has_value());
    EXPECT_EQ(std::string(from_host->bytes.begin(), from_host->bytes.end()), bytes);
    EXPECT_TRUE(from_host->from.is_loopback());
    EXPECT_EQ(DecodePacket(xt16, side.Receive(kPatience_ms).value().bytes, turns), std::nullopt);
  }
  const Ended ended = stream.Wait();
  EXPECT_EQ(ended.status, 0) << ended.said;
  EXPECT_THAT(ended.said, testing::StartsWith("railcast: railcast to " + EndpointText(front.at()) +
                                              "\nvlp16: vlp16 to " + EndpointText(group.at()) +
                                              " to " + EndpointText(host.at()) +
                                              "\nxt16: xt16 to " + EndpointText(side.at()) + "\n"));
}

// As the test of the client that brakes by IPv4, and all of it by IPv6.
TEST(StreamAddresses, OfIpv6ServeAVehicleInTheLoop) {
  if (!AnyIpv6LoopbackPort()) GTEST_SKIP() << "this machine has no IPv6 at ::1";
  const TemporaryDirectory folder;
  const std::string scenario = CoarseScenario(folder.path());
  const std::string stream_at = "[::1]:" + FreePort();
  const std::string commands_port = FreePort();
  Stream stream(scenario + " --lockstep --duration 20 --fields x,y,z --pacing burst --to " +
                stream_at + " --commands-port " + commands_port + " --commands-from ::1" +
                " & pid=$!; " RAILCAST_SOURCE_DIR
                "/examples/brake_client.py --lockstep --front 0 " +
                "--resolution 0.5 --deceleration 2 --stream " + stream_at + " --commands [::1]:" +
                commands_port + "; status=$?; kill -INT $pid; wait $pid; exit $status");
  const Ended ended = stream.Wait();
  EXPECT_EQ(ended.status, 0) << ended.said;
  EXPECT_THAT(ended.said, testing::HasSubstr("with 10.00 m/s, braking distance 25.5 m, gap left "));
  EXPECT_THAT(ended.said, testing::HasSubstr("commands at [::1]:" + commands_port + "\n"));
}

TEST(StreamAddresses, OfIpv6MakeACaptureOfIpv6) {
  const auto ipv6 = AnyIpv6LoopbackPort();
  if (!ipv6) GTEST_SKIP() << "this machine has no IPv6 at ::1";
  const TemporaryDirectory folder;
  const std::string scenario = CoarseScenario(folder.path());
  StreamReceiver receiver(*ipv6);
  const auto capture = folder.path() / "a.pcap";
  const auto captured = [&](const std::string& others) {
    const Ended ended =
        Generate("stream " + scenario + " --duration 0.05 --pcap " + capture.string() + " --to " +
                 EndpointText(receiver.at()) + others);
    EXPECT_EQ(ended.status, 0) << ended.said;
    // Of the first frame of Ethernet.
    return ReadFileWhole(capture).substr(24 + 16 + 12, 2);
  };
  EXPECT_EQ(captured(""), "\x86\xDD");
  EXPECT_EQ(captured(" --to :9"), std::string("\x08\0", 2));
}

TEST(StreamAddresses, AreRefusedWhereNothingCanBeSent) {
  const TemporaryDirectory folder;
  const std::string scenario = CoarseScenario(folder.path());
  const auto fault = [&](const std::string& options) {
    const Ended ended = Generate("stream " + scenario + " --duration 0.05 " + options);
    EXPECT_EQ(ended.status, 1);
    return ended.said;
  };
  EXPECT_EQ(fault("--to fe80::1"),
            "--to: must name the network interface, as [fe80::1%eth0]:2368 does (got fe80::1)\n");
  EXPECT_EQ(fault("--to '[::1'"),
            "--to: must be an IPv6 address, as [::1]:2368 or [fe80::1%eth0]:2368 (got [::1)\n");
  EXPECT_EQ(fault("--to 239.1.1.1%no_such_one"),
            "--to: must name a network interface of this machine behind % (got "
            "239.1.1.1%no_such_one)\n");
  EXPECT_EQ(fault("--commands-port 9 --commands-from ::1%lo"),
            "--commands-from: must name no network interface, which multicast groups and "
            "link-local addresses alone have (got ::1%lo)\n");
}

/// The time that the first packet of an XT16 states, less the time of day, in s.
double AheadOfDay_s(const std::string& clock) {
  const TemporaryDirectory folder;
  UdpReceiver receiver(kAnyLoopbackPort);
  const std::string scenario = ScenarioOfSensors(
      folder.path(),
      {{"xt16", Quote(receiver.at())}, {"vlp16", "\"127.0.0.1:" + FreePort() + "\""}});
  Stream stream(scenario + " --duration 0.2 --clock " + clock);
  SpinningDecoder decoder(*FindSpinningModel("xt16"));
  std::vector<SensorTurn> turns;
  EXPECT_EQ(DecodePacket(decoder, receiver.Receive(kPatience_ms).value().bytes, turns),
            std::nullopt);
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  const Ended ended = stream.Wait();
  EXPECT_EQ(ended.status, 0) << ended.said;
  return 1e-9 * static_cast<double>(decoder.TakeUnfinished().stamp_ns) -
         std::chrono::duration<double>(now).count();
}

// Packets leave within a period, 0.1 s, of their last firing. A busy machine may receive them late,
// but not half a minute late.
TEST(StreamClock, StatesTheTimeOfDayOrAtomicTime) {
  const double utc_s = AheadOfDay_s("utc");
  EXPECT_LE(utc_s, 0.0);
  EXPECT_GT(utc_s, -30.0);
  const double tai_s = AheadOfDay_s("tai");
  EXPECT_LE(tai_s, 37.0);
  EXPECT_GT(tai_s, 37.0 - 30.0);
  // 2000-01-01 00:00:00, and less than a minute.
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  EXPECT_NEAR(AheadOfDay_s("simulated"), 946'684'800.0 - std::chrono::duration<double>(now).count(),
              60.0);
}

TEST(StreamClock, IsForLiveStreamsAndAtomicTimeForWhatFollowsPtp) {
  const TemporaryDirectory folder;
  const std::string scenario = CoarseScenario(folder.path());
  const auto fault = [](const std::string& arguments) {
    const Ended ended = Generate("stream " + arguments);
    EXPECT_EQ(ended.status, 1);
    return ended.said;
  };
  EXPECT_EQ(fault(scenario + " --clock utc --pcap a --duration 1"),
            "--clock: must be left out where nothing is sent, as with --pcap without --to\n");
  EXPECT_EQ(
      fault(ScenarioOfSensors(folder.path(), {{"vlp16", "\"127.0.0.1:9\""}}) + " --clock tai"),
      "--clock: tai is for packets of sensors that PTP synchronises, Hesai's and Ouster's "
      "(got vlp16)\n");
}

}  // namespace
}  // namespace railcast
