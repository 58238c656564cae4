// Packets of real sensors, live and as captures, against the frames that `sequence` writes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "core/extras/packets/spinning/spinning_decoder.h"
#include "railcast/io/recording.h"
#include "tests/core/io/recording/read_all.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/live/live_process.h"
#include "tests/support/decode_packet.h"
#include "tests/support/exits_with.h"

namespace railcast {
namespace {

/// The wagon of CoarseScenario() before a real sensor.
std::string ScenarioWith(const std::string& sensor, const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / (sensor + ".json");
  WriteFileWhole(file, R"({"version": 1, "file": ")" + CoarseScenario(folder) +
                           R"(", "fidelity": "plausibility", "output": {"frame": "sensor"},
                           "lidar": ")" +
                           kScenariosFolder + "sensors/" + sensor + R"(.json"})");
  return file.string();
}

/// Compares the slots of a turn with those of the frame that it was made of.
void ExpectSameSlots(const Frame& turn, const Frame& frame) {
  ASSERT_EQ(turn.rows, frame.rows);
  ASSERT_EQ(turn.columns, frame.columns);
  std::size_t num_points = 0;
  for (std::size_t i = 0; i < frame.num_slots(); ++i) {
    ASSERT_EQ(std::isnan(turn.x[i]), std::isnan(frame.x[i])) << i;
    if (std::isnan(frame.x[i])) continue;
    ++num_points;
    ASSERT_NEAR(turn.range_m[i], std::hypot(frame.x[i], frame.y[i], frame.z[i]), 0.0021);
    // Packets say percent, of 255 at most.
    ASSERT_NEAR(turn.intensity[i], std::min(frame.intensity[i], 2.55F), 0.0051);
  }
  EXPECT_GT(num_points, frame.num_slots() / 4);
}

class SentPackets : public testing::TestWithParam<const char*> {};

TEST_P(SentPackets, OfACaptureHaveTheFramesThatSequenceWrites) {
  const std::string sensor = GetParam();
  const TemporaryDirectory folder;
  const std::string scenario = ScenarioWith(sensor, folder.path());
  const auto capture = folder.path() / "out.pcap";
  ASSERT_THAT(Generate("stream " + scenario + " --protocol " + sensor + " --duration 0.3 --pcap " +
                       capture.string()),
              ExitsWith(0));
  const auto out = folder.path() / "out";
  ASSERT_THAT(Generate("sequence " + scenario + " --frames 2 --out " + out.string()), ExitsWith(0));
  const auto turns = ReadAll(capture);
  const auto frames = ReadAll(out);
  ASSERT_EQ(turns.size(), 3U);
  ASSERT_EQ(frames.size(), 2U);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    ExpectSameSlots(turns[i].frame, frames[i].frame);
    if (HasFatalFailure()) return;
  }
}

INSTANTIATE_TEST_SUITE_P(Sensors,
                         SentPackets,
                         testing::Values("xt16", "pandar128e4x", "vls128", "at128"),
                         [](const auto& test) { return std::string(test.param); });

TEST(LivePackets, ArriveAtADecoder) {
  const TemporaryDirectory folder;
  const std::string scenario = ScenarioWith("xt16", folder.path());
  UdpReceiver receiver(kAnyLoopbackPort);
  Stream stream(scenario + " --protocol xt16 --duration 0.3 --to " + EndpointText(receiver.at()));
  SpinningDecoder decoder(*FindSpinningModel("xt16"));
  std::vector<SensorTurn> turns;
  // Three frames of 2000 columns, 8 in a packet.
  for (int i = 0; i < 750; ++i) {
    const auto received = receiver.Receive(kPatience_ms);
    ASSERT_TRUE(received.has_value());
    EXPECT_EQ(DecodePacket(decoder, received->bytes, turns), std::nullopt);
  }
  turns.push_back(decoder.TakeUnfinished());
  ASSERT_EQ(turns.size(), 3U);
  for (const SensorTurn& turn : turns) EXPECT_EQ(turn.num_columns(), 2000U);
  EXPECT_THAT(stream.Wait(), ExitsWith(0, testing::HasSubstr("XT16: xt16 to ")));
}

}  // namespace
}  // namespace railcast
