// A simulated Ouster sensor: its captures, its packets on the network and its HTTP interface.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/extras/packets/ouster/ouster_decoder.h"
#include "core/io/net/udp.h"
#include "core/io/write_file.h"
#include "railcast/io/recording.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/live/live_process.h"
#include "tests/support/decode_packet.h"
#include "tests/support/exits_with.h"
#include "tests/support/loopback.h"
#include "tests/support/ouster_metadata_text.h"

namespace railcast {
namespace {

/// A scenario of a sensor of made metadata that drives past a wagon.
std::string OusterScenario(const std::filesystem::path& folder, const std::string& profile) {
  WriteFileWhole(folder / "os.json", MadeOusterMetadataText(profile, 100, 400));
  WriteFileWhole(folder / "drive.json", R"({
    "version": 1,
    "fidelity": "surface",
    "lidar": {"ouster_metadata": "os.json", "mount": {"position_m": [1, 0, 2.5]}},
    "interfaces": {"protocol": "ouster"},
    "world": {
      "alignment": {
        "course": {"type": "elements", "elements": [{"type": "straight", "length_m": 600}]}
      },
      "catenary": {"enabled": false},
      "vegetation": {"trees_per_hectare": 0, "grass": false},
      "objects": [{"name": "wagon", "type": "open_wagon", "s_m": 220}]
    },
    "vehicle": {"start_s_m": 200, "motion": {"profile": [{"time_s": 0, "speed_mps": 10}]}},
    "materials": ")" + kScenariosFolder +
                                            R"(materials/railway.json",
    "labels": ")" + kScenariosFolder + R"(labels.json"
  })");
  return (folder / "drive.json").string();
}

std::vector<RecordedFrame> FramesOf(const std::filesystem::path& source) {
  std::vector<RecordedFrame> frames;
  const auto recording = OpenRecording(source);
  while (const auto read = recording->Next()) frames.push_back((*read)());
  return frames;
}

class StreamedProfile : public testing::TestWithParam<const char*> {};

TEST_P(StreamedProfile, IsCapturedAsSequenceWritesItsFrames) {
  const TemporaryDirectory folder;
  const std::string scenario = OusterScenario(folder.path(), GetParam());
  const auto capture = folder.path() / "drive.pcap";
  ASSERT_THAT(Generate("stream " + scenario + " --duration 0.3 --pcap " + capture.string()),
              ExitsWith(0));
  const auto out = folder.path() / "out";
  ASSERT_EQ(Generate("sequence " + scenario + " --frames 3 --out " + out.string()).status, 0);
  // The metadata were written beside the capture.
  EXPECT_EQ(OpenRecording(capture)->info().kind, "capture of OS-1-4");
  const auto captured = FramesOf(capture);
  const auto truth = FramesOf(out);
  ASSERT_EQ(captured.size(), 3U);
  ASSERT_EQ(truth.size(), 3U);
  std::size_t num_points = 0;
  for (std::size_t f = 0; f < 3; ++f) {
    const Frame& a = captured[f].frame;
    const Frame& b = truth[f].frame;
    ASSERT_EQ(a.num_slots(), b.num_slots());
    for (std::size_t i = 0; i < a.num_slots(); ++i) {
      ASSERT_EQ(std::isnan(a.x[i]), std::isnan(b.x[i]));
      if (std::isnan(a.x[i])) continue;
      // Half of the unit of 8 mm.
      ASSERT_NEAR(a.range_m[i], b.range_m[i], 0.0041);
      ASSERT_NEAR(a.x[i], b.x[i], 0.0041);
      ASSERT_NEAR(a.y[i], b.y[i], 0.0041);
      ASSERT_NEAR(a.z[i], b.z[i], 0.0041);
      ++num_points;
    }
  }
  EXPECT_GT(num_points, 500U);
}

INSTANTIATE_TEST_SUITE_P(StreamOuster,
                         StreamedProfile,
                         testing::Values("LEGACY",
                                         "RNG19_RFL8_SIG16_NIR16_DUAL",
                                         "RNG15_RFL8_NIR8"),
                         [](const auto& test) { return std::string(test.param); });

// Python's own client asks as a driver does, and then listens.
TEST(StreamOuster, TellsADriverOverHttpWhatItSends) {
  const TemporaryDirectory folder;
  const std::string scenario = OusterScenario(folder.path(), "RNG19_RFL8_SIG16_NIR16");
  UdpReceiver receiver(kAnyLoopbackPort);
  const std::string port = FreePort();
  const auto pid_file = folder.path() / "pid";
  Stream stream(scenario + " --duration 25 --http 127.0.0.1:" + port + " --to " +
                EndpointText(receiver.at()) + NotedIn(pid_file));
  const auto first = receiver.Receive(kPatience_ms);
  ASSERT_TRUE(first.has_value());
  const std::vector<char> packet(first->bytes.begin(), first->bytes.end());
  const Ended asked = RunCommand(
      "python3 - <<'EOF'\nimport http.client\nclient = "
      "http.client.HTTPConnection('127.0.0.1', " +
      port +
      ")\nclient.request('GET', '/api/v1/sensor/metadata')\n"
      "print(client.getresponse().read().decode())\nEOF\ntest $? = 0");
  ASSERT_EQ(asked.status, 0) << asked.said;
  const auto metadata = nlohmann::json::parse(asked.said);
  EXPECT_EQ(metadata["config_params"]["udp_dest"], "127.0.0.1");
  EXPECT_EQ(metadata["config_params"]["udp_port_lidar"], receiver.at().port);
  OusterDecoder decoder(ParseOusterMetadata(asked.said));
  std::vector<SensorTurn> turns;
  EXPECT_EQ(DecodePacket(decoder, packet, turns), std::nullopt);
  Interrupt(pid_file);
  EXPECT_THAT(stream.Wait(), ExitsWith(0, testing::HasSubstr("HTTP at 127.0.0.1:" + port)));
}

// By PTP, as a driver finds out over HTTP, which IPv6 brings here, too.
TEST(StreamOuster, StatesAtomicTimeAndThatItIs) {
  const auto ipv6 = AnyIpv6LoopbackPort();
  if (!ipv6) GTEST_SKIP() << "this machine has no IPv6 at ::1";
  const TemporaryDirectory folder;
  const std::string scenario = OusterScenario(folder.path(), "RNG19_RFL8_SIG16_NIR16");
  UdpReceiver receiver(*ipv6);
  const std::string port = FreePort();
  const auto pid_file = folder.path() / "pid";
  Stream stream(scenario + " --duration 25 --clock tai --http '[::1]:" + port + "' --to " +
                EndpointText(receiver.at()) + NotedIn(pid_file));
  const auto first = receiver.Receive(kPatience_ms);
  ASSERT_TRUE(first.has_value());
  const std::vector<char> packet(first->bytes.begin(), first->bytes.end());
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  const Ended asked = RunCommand(
      "python3 -c \"import http.client; client = http.client.HTTPConnection('::1', " + port +
      "); client.request('GET', '/api/v1/sensor/metadata'); "
      "print(client.getresponse().read().decode())\"");
  ASSERT_EQ(asked.status, 0) << asked.said;
  const auto config = nlohmann::json::parse(asked.said)["config_params"];
  EXPECT_EQ(config["timestamp_mode"], "TIME_FROM_PTP_1588");
  EXPECT_EQ(config["udp_dest"], "::1");
  EXPECT_EQ(config["udp_port_lidar"], receiver.at().port);
  OusterDecoder decoder(ParseOusterMetadata(asked.said));
  std::vector<SensorTurn> turns;
  EXPECT_EQ(DecodePacket(decoder, packet, turns), std::nullopt);
  const double ahead_s = 1e-9 * static_cast<double>(decoder.TakeUnfinished().stamp_ns) -
                         std::chrono::duration<double>(now).count();
  EXPECT_LE(ahead_s, 37.0);
  EXPECT_GT(ahead_s, 37.0 - 30.0);
  Interrupt(pid_file);
  EXPECT_THAT(stream.Wait(), ExitsWith(0, testing::HasSubstr("HTTP at [::1]:" + port)));
}

// In a network of its own, whose MTU the packets exceed; the kernel counts the fragments.
TEST(StreamOuster, SendsPacketsAboveTheMtuInIpFragments) {
  const std::string alone = "unshare --map-root-user --net ";
  if (RunCommand(alone + "ip link set lo mtu 576 up").status != 0) {
    GTEST_SKIP() << "no network of its own can be made here";
  }
  const TemporaryDirectory folder;
  const std::string scenario = OusterScenario(folder.path(), "RNG19_RFL8_SIG16_NIR16");
  const auto script = folder.path() / "receive.py";
  WriteFileWhole(script, R"(import socket, subprocess
subprocess.run(["ip", "link", "set", "lo", "mtu", "576", "up"], check=True)
receiver = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
receiver.bind(("127.0.0.1", 7502))
receiver.settimeout(20)
stream = subprocess.Popen([")" RAILCAST_GENERATE R"(", "stream", ")" +
                             scenario +
                             R"(", "--duration", "0.2", "--to", "127.0.0.1:7502"],
                          stdout=subprocess.DEVNULL)
print({len(receiver.recv(65536)) for _ in range(20)}, stream.wait())
names, counts = (line.split() for line in open("/proc/net/snmp") if line.startswith("Ip:"))
print(int(counts[names.index("FragCreates")]) >= 40)
)");
  const Ended received = RunCommand(alone + "python3 " + script.string());
  const std::size_t size = OusterPacketSize(ParseOusterMetadata(MadeOusterMetadataText()));
  EXPECT_GT(size, 576U);
  EXPECT_EQ(received.said, "{" + std::to_string(size) + "} 0\nTrue\n");
}

TEST(StreamOuster, SaysWhatDoesNotGoTogether) {
  const TemporaryDirectory folder;
  const std::string scenario = OusterScenario(folder.path(), "LEGACY");
  const std::string coarse = CoarseScenario(folder.path());
  const auto fault = [](const std::string& arguments) {
    const Ended ended = Generate("stream " + arguments);
    EXPECT_EQ(ended.status, 1);
    return ended.said;
  };
  EXPECT_EQ(fault(coarse + " --duration 1 --http :8080"),
            "--http: is for one sensor of protocol ouster (got railcast)\n");
  EXPECT_EQ(
      fault(coarse + " --duration 1 --protocol ouster"),
      "--protocol ouster: /lidar/ouster_metadata: must name the metadata of the sensor, which "
      "its packets follow (got none)\n");
  EXPECT_EQ(fault(scenario + " --duration 1 --pcap a.pcap --http :8080"),
            "--http: must be left out where nothing is sent, as with --pcap without --to\n");
  EXPECT_EQ(fault(scenario + " --to 127.0.0.1:7503"),
            "receivers of OS-1-4: must not be where OS-1-4 sends position packets (got "
            "127.0.0.1:7503)\n");
  // A file that is no metadata is not replaced.
  const auto other = folder.path() / "mine_0.json";
  WriteFileWhole(other, "{}");
  EXPECT_EQ(fault(scenario + " --duration 1 --pcap " + (folder.path() / "mine.pcap").string()),
            other.string() +
                ": must be absent or the metadata of an Ouster sensor, which are written "
                "beside the capture\n");
  EXPECT_EQ(ReadFileWhole(other), "{}");
}

}  // namespace
}  // namespace railcast
