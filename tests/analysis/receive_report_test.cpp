#include "analysis/receive/receive_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "tests/core/io/message_of.h"
#include "tests/core/io/temporary_directory.h"

namespace railcast {
namespace {

ReceivedTotals Totals() {
  return {.frames = 21,
          .points = 21 * 16'000,
          .first_s = 100.0,
          .last_s = 102.5,
          .last_arrival_ns = {},
          .between = {},
          .latency = {},
          .frames_ahead = {}};
}

constexpr std::int64_t kMs_ns = 1'000'000;
constexpr std::int64_t kNow_ns = 1'795'000'000'000'000'000;

/// A frame of which the last datagram arrives so long after the stamp, and the last firing is 100
/// ms after that.
ReceivedFrame FrameAt(std::int64_t stamp_ns, std::int64_t arrival_ns) {
  ReceivedFrame frame;
  frame.header.stamp_ns = stamp_ns;
  frame.header.duration_ns = 100 * kMs_ns;
  frame.header.point_size = 4;
  frame.points.resize(40);
  frame.first_arrival_ns = arrival_ns - 90 * kMs_ns;
  frame.last_arrival_ns = arrival_ns;
  return frame;
}

TEST(ReceivedFiles, AreNotPutWhereLinksLead) {
  for (const std::string name : {"frames", "frames.csv", "frames/000000.pcd"}) {
    const TemporaryDirectory directory;
    const auto out = directory.path() / "out";
    create_directories((out / name).parent_path());
    create_directory(directory.path() / "mine");
    std::filesystem::create_symlink("../mine/nothing", out / name);
    EXPECT_EQ(MessageOf([&] { const ReceivedFiles files(out); }),
              (out / name).string() + ": must not be a symbolic link");
    EXPECT_TRUE(is_empty(directory.path() / "mine"));
  }
}

TEST(ReceiveReport, KnowsTheLatencyOfStampsThatAreATimeOfDay) {
  EXPECT_EQ(LatencyOf(FrameAt(kNow_ns, kNow_ns + 103 * kMs_ns)), 3 * kMs_ns);
  // The sender's clock is ahead.
  EXPECT_EQ(LatencyOf(FrameAt(kNow_ns, kNow_ns + 98 * kMs_ns)), -2 * kMs_ns);
  const std::int64_t hour_ns = 3'600'000 * kMs_ns;
  EXPECT_NE(LatencyOf(FrameAt(kNow_ns, kNow_ns + hour_ns)), std::nullopt);
  EXPECT_EQ(LatencyOf(FrameAt(kNow_ns, kNow_ns + hour_ns + 1)), std::nullopt);
  EXPECT_EQ(LatencyOf(FrameAt(kNow_ns, kNow_ns - hour_ns - 1)), std::nullopt);
  EXPECT_EQ(LatencyOf(FrameAt(0, kNow_ns)), std::nullopt);
  EXPECT_EQ(LatencyOf(FrameAt(std::numeric_limits<std::int64_t>::min(), kNow_ns)), std::nullopt);
}

TEST(ReceiveReport, TellsTimesOfArrival) {
  ReceivedTotals totals;
  for (const std::int64_t ms : {0, 100, 200, 350}) {
    const std::int64_t stamp_ns = kNow_ns + ms * kMs_ns;
    totals.Add(FrameAt(stamp_ns, stamp_ns + 104 * kMs_ns));
  }
  EXPECT_EQ(totals.frames, 4U);
  EXPECT_EQ(totals.points, 40U);
  const std::string text = ReceiveSummary(totals, {});
  EXPECT_THAT(text,
              testing::EndsWith("\nlatency since the last firing: p50 4.000 ms, p99 4.000 ms, "
                                "most 4.000 ms\n"));
  EXPECT_THAT(text, testing::HasSubstr("\nfrom frame to frame: p50 100."));
  const auto json = nlohmann::json::parse(ReceiveSummaryJson(totals, {}));
  // Quantiles are exact to 1 %.
  EXPECT_NEAR(json.at("from_frame_to_frame_ms").at("p50"), 100.0, 1.0);
  EXPECT_NEAR(json.at("from_frame_to_frame_ms").at("p99"), 150.0, 1.5);
  EXPECT_NEAR(json.at("latency_ms").at("p99"), 4.0, 0.04);
  EXPECT_EQ(json.at("latency_ms").at("max"), 4.0);
  EXPECT_EQ(json.at("frames_ahead"), 0);
}

TEST(ReceiveReport, SaysHowManyFramesCameBeforeTheirLastFiring) {
  ReceivedTotals totals;
  totals.Add(FrameAt(kNow_ns, kNow_ns + 104 * kMs_ns));
  totals.Add(FrameAt(kNow_ns, kNow_ns + 98 * kMs_ns));
  EXPECT_THAT(
      ReceiveSummary(totals, {}),
      testing::EndsWith("\nframes before their last firing: 1, whose latency counts as 0; the "
                        "sender's clock is ahead\n"));
  EXPECT_THAT(ReceiveSummaryJson(totals, {}), testing::HasSubstr(R"("frames_ahead":1)"));
}

StreamReceiver::Counts Counts() {
  StreamReceiver::Counts counts;
  counts.stream.complete_frames = 20;
  counts.stream.incomplete_frames = 1;
  counts.stream.missing_frames = 2;
  counts.stream.received_packets = 8620;
  counts.stream.lost_packets = 3;
  counts.stream.duplicate_packets = 4;
  counts.stream.reordered_packets = 5;
  counts.stream.late_packets = 6;
  counts.stream.stray_packets = 7;
  counts.dropped_frames = 8;
  return counts;
}

TEST(ReceiveReport, SumsUpWhatCameAndWhatDidNot) {
  EXPECT_EQ(ReceiveSummary(Totals(), Counts()),
            "frames: 20 complete, 1 incomplete, 2 missing, 8 dropped here; 8.00 Hz\n"
            "packets: 8620 received, 3 lost, 4 duplicate, 5 reordered, 6 late, 7 stray, 0 refused\n"
            "points: 336000, 16000 a frame\n"
            "latency: unknown, stamps are not of this machine's clock, as --clock utc of the "
            "sender states it\n");
}

TEST(ReceiveReport, KnowsItsShareOnlyOfARunThatHasAnEnd) {
  EXPECT_EQ(ReceivedShare(Totals(), 5.0, {}), std::nullopt);
  EXPECT_EQ(ReceivedShare(Totals(), 5.0, {.num_frames = 84, .duration_s = {}}), 0.25);
  EXPECT_EQ(ReceivedShare(Totals(), 5.0, {.num_frames = {}, .duration_s = 10.0}), 0.5);
  EXPECT_EQ(ReceivedShare(Totals(), 5.0, {.num_frames = 84, .duration_s = 10.0}), 0.5);
  EXPECT_EQ(ReceivedShare(Totals(), 11.0, {.num_frames = {}, .duration_s = 10.0}), 1.0);
}

TEST(ReceiveReport, SaysWhyDatagramsWereRefusedAndThatTheSenderBeganAnew) {
  StreamReceiver::Counts counts;
  counts.stream.restarts = 1;
  counts.stream.refused[static_cast<std::size_t>(StreamFault::kMagic)] = 2;
  counts.stream.refused[static_cast<std::size_t>(StreamFault::kChecksum)] = 1;
  EXPECT_EQ(ReceiveSummary({}, counts),
            "frames: 0 complete, 0 incomplete, 0 missing, 0 dropped here; no rate yet\n"
            "packets: 0 received, 0 lost, 0 duplicate, 0 reordered, 0 late, 0 stray, 3 refused\n"
            "points: 0, 0 a frame\n"
            "restarts of the sender: 1\n"
            "refused for: magic 2 checksum 1\n");
}

TEST(ReceiveReport, SaysWhoElseSent) {
  StreamReceiver::Counts counts;
  counts.stream.other_sender_packets = 3;
  counts.stream.other_sender = Endpoint{0x0A000007, 4711};
  EXPECT_EQ(ReceiveSummary({}, counts),
            "frames: 0 complete, 0 incomplete, 0 missing, 0 dropped here; no rate yet\n"
            "packets: 0 received, 0 lost, 0 duplicate, 0 reordered, 0 late, 0 stray, 0 refused\n"
            "points: 0, 0 a frame\n"
            "packets of other senders: 3, dropped; the last from 10.0.0.7:4711\n");
}

TEST(ReceiveReport, IsJsonInOneLine) {
  StreamReceiver::Counts counts = Counts();
  counts.stream.refused[static_cast<std::size_t>(StreamFault::kMagic)] = 2;
  EXPECT_EQ(ReceiveSummaryJson(Totals(), counts),
            R"({"command":"receive","frames":{"complete":20,"incomplete":1,"missing":2,)"
            R"("dropped_here":8},"rate_hz":8.0,"packets":{"received":8620,"lost":3,"duplicate":4,)"
            R"("reordered":5,"late":6,"stray":7,"of_other_senders":0,"refused":2},)"
            R"("refused_for":{"magic":2},"points":336000,"from_frame_to_frame_ms":null,)"
            R"("latency_ms":null,"frames_ahead":0,"restarts_of_the_sender":0})"
            "\n");
  EXPECT_NE(ReceiveSummaryJson({}, {}).find(R"("rate_hz":null)"), std::string::npos);
}

TEST(ReceiveReport, TellsHowItGoes) {
  EXPECT_EQ(ReceiveProgress(Totals(), Counts()),
            "21 frames, 16000 points each, 8.00 Hz, 3 packets lost");
}

}  // namespace
}  // namespace railcast
