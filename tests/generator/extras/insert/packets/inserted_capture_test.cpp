#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string>

#include "core/extras/insert/insertion_verification.h"
#include "core/extras/packets/pcap/pcap_reader.h"
#include "core/extras/packets/pcap/pcap_writer.h"
#include "core/extras/packets/recording/packet_recording.h"
#include "core/extras/packets/spinning/spinning_encoder.h"
#include "core/io/write_file.h"
#include "generator/extras/insert/packets/insertion.h"
#include "generator/extras/insert/run/insert_run.h"
#include "tests/core/extras/packets/velodyne/made_scan.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/recording/read_all.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/extras/insert/packets/hand_edits.h"
#include "tests/generator/extras/insert/packets/sent_as_written.h"
#include "tests/generator/extras/insert/plan/plan_project.h"
#include "tests/support/hesai_bag.h"
#include "tests/support/sensor_file.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

// From a plan to the packets: what is written to a capture, read again, and sent.

class InsertedCapture : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    const MadeScan scan(ReadSensor(std::string(SensorOf(GetParam()))));
    const ReturnMode mode = ReturnModeOfFormat(GetParam());
    const auto encoder = MakeSpinningEncoder(*FindSpinningModel(GetParam()), scan.spec(), mode);
    Datagrams datagrams;
    for (const std::uint32_t i : {0U, 1U, 2U}) {
      encoder->Encode(scan.MakeFrame(i, mode == ReturnMode::kDual ? 2 : 1), datagrams);
    }
    PcapWriter writer(capture(), 2368, 8308);
    writer.Write(datagrams, datagrams.items);
    writer.Finish();
  }

  [[nodiscard]] fs::path capture() const { return folder_.path() / "drive.pcap"; }

  /// Puts a box around 6 m ahead of the sensor.
  [[nodiscard]] InsertIntoFrame BoxAhead() const { return MakeInsertion(Plan(), capture()); }
  [[nodiscard]] fs::path Plan() const {
    const std::string lidar = "\"lidar\": {\"file\": \"" RAILCAST_SOURCE_DIR "/scenarios/sensors/" +
                              std::string(SensorOf(GetParam())) +
                              ".json\", \"receiver\": {\"return_mode\": \"" +
                              std::string(NameOf(ReturnModeOfFormat(GetParam()))) + "\"}}, ";
    return WritePlan(
        folder_.path(), R"({"poses": "standing"})",
        R"(, "objects": [{"type": "box", "name": "crate", "size_m": [1, 2, 6], "s_m": 6, "d_m": 0, "h_m": 0}])",
        lidar);
  }

  TemporaryDirectory folder_;
};

TEST_P(InsertedCapture, IsReadAgainAsItWasInserted) {
  const InsertIntoFrame insert = BoxAhead();
  const auto frames = CopyWithEdits(capture(), folder_.path() / "out", insert);
  const auto read = ReadAll(folder_.path() / "out/drive.pcap");
  ASSERT_EQ(read.size(), frames.size());
  std::size_t num_added = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const Frame& expected = frames[i].recorded.frame;
    ASSERT_EQ(read[i].frame.num_slots(), expected.num_slots());
    for (const SlotEdit& edit : frames[i].edits) num_added += edit.is_added ? 1 : 0;
    for (std::size_t slot = 0; slot < expected.num_slots(); ++slot) {
      const float got_m = read[i].frame.range_m[slot];
      ASSERT_EQ(std::isnan(got_m), std::isnan(expected.range_m[slot])) << slot;
      if (std::isnan(got_m)) continue;
      // Half a unit of VLP-32C's distances.
      ASSERT_NEAR(got_m, expected.range_m[slot], 0.0021F) << slot;
    }
  }
  EXPECT_GT(num_added, 100U);
}

// What is sent live is what is written to the file.
TEST_P(InsertedCapture, IsSentAsItIsWritten) {
  ExpectSentAsWritten(capture(), folder_.path() / "out", BoxAhead());
}

TEST_P(InsertedCapture, IsCheckedAgainstItsHash) {
  const InsertChoices choices = {
      .recording = capture(), .plan = Plan(), .directory = folder_.path() / "out"};
  const InsertPlan plan = ReadInsertPlan(choices.plan, capture());
  (void)RunInsert(choices, plan, {[](std::uint32_t, std::uint32_t) {}, [] { return false; }});
  EXPECT_THAT(VerifyInsertion(choices.directory, [](double) {}).faults, testing::IsEmpty());
  const fs::path copy = choices.directory / "recording/drive.pcap";
  std::string bytes = ReadFileWhole(copy);
  bytes.back() = static_cast<char>(bytes.back() ^ 1);
  WriteFileWhole(copy, bytes);
  EXPECT_THAT(VerifyInsertion(choices.directory, [](double) {}).faults,
              testing::ElementsAre(testing::StartsWith(copy.string() + ": must have the hash ")));
}

// Another sensor's channels, of the same number and of another one.
TEST_P(InsertedCapture, IsRefusedByTheCheckAsByTheRunIfThePlanHasAnotherSensor) {
  for (const std::string sensor : {"vlp16", "hdl32e", "pandar64"}) {
    if (sensor == SensorOf(GetParam())) continue;
    const fs::path file =
        WritePlan(folder_.path(), R"({"poses": "standing"})", "",
                  "\"lidar\": \"" RAILCAST_SOURCE_DIR "/scenarios/sensors/" + sensor + ".json\", ");
    const InsertChoices choices = {
        .recording = capture(), .plan = file, .directory = folder_.path() / "none"};
    const InsertPlan plan = ReadInsertPlan(file, capture());
    const std::string refusal = MessageOf([&] { static_cast<void>(CheckInsert(choices, plan)); });
    EXPECT_THAT(refusal, testing::HasSubstr("its firings cannot be found: ")) << sensor;
    EXPECT_EQ(refusal, MessageOf([&] {
                static_cast<void>(RunInsert(
                    choices, plan, {[](std::uint32_t, std::uint32_t) {}, [] { return false; }}));
              }))
        << sensor;
    EXPECT_FALSE(exists(choices.directory));
  }
}

INSTANTIATE_TEST_SUITE_P(Velodyne,
                         InsertedCapture,
                         testing::Values("vlp16", "vlp16-dual", "vlp32c"));

class SentCaptures : public testing::TestWithParam<const char*> {};

// What is sent live is what is written to the file.
TEST_P(SentCaptures, AreWhatIsWritten) {
  const auto source = std::filesystem::path(RAILCAST_SHARED_DATA_DIR) / GetParam();
  if (!exists(source)) GTEST_SKIP() << source << " is not there";
  const TemporaryDirectory folder;
  ExpectSentAsWritten(source, folder.path(), EditedByHand);
}

INSTANTIATE_TEST_SUITE_P(All,
                         SentCaptures,
                         testing::Values("lidar_packets_nebula/vlp16_dual.pcap",
                                         "lidar_packets_nebula/pandar64.pcap",
                                         "lidar_ouster/OS-1-128_v2.3.0_1024x10_lb_n3.pcap"),
                         [](const auto& test) { return "Number" + std::to_string(test.index); });

// `replay` takes them from there, turn by turn.
TEST(InsertedDatagrams, OfABagAreItsPacketsWithTheEdits) {
  if (const auto why = WhyNoHesaiBag("xt32"); !why.empty()) GTEST_SKIP() << why;
  const TemporaryDirectory folder;
  static_cast<void>(CopyWithEdits(HesaiBag("xt32"), folder.path(), EditedByHand));
  const auto written = FindBagPackets({folder.path() / "xt32.db3"})->open();
  PacketRecording sent(PlaceOfInserted(*FindBagPackets({HesaiBag("xt32")}), EditedByHand));
  std::size_t num_sent = 0;
  for (auto turn = sent.NextTurn(); !turn.empty(); turn = sent.NextTurn()) {
    for (const RecordedDatagram& datagram : turn) {
      const auto expected = written->Next();
      ASSERT_TRUE(expected);
      ASSERT_TRUE(std::ranges::equal(datagram.bytes, expected->payload)) << num_sent;
      ++num_sent;
    }
  }
  EXPECT_FALSE(written->Next());
  EXPECT_GT(num_sent, 50U);
}

}  // namespace
}  // namespace railcast
