#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <vector>

#include "core/base/units.h"
#include "generator/live/live_summary.h"

namespace railcast {
namespace {

TEST(LiveSummary, TellsFramesDatagramsAndQuantiles) {
  LiveRecord record{.name = "front", .period_ns = 100'000'000, .frames = 3, .late_frames = 1};
  for (const std::int64_t ms : {2, 2, 5}) record.compute.Add(ms * 1'000'000);
  record.sent.datagrams = 12;
  record.sent.bytes = 16'800;
  for (int i = 0; i < 3; ++i) record.sent.send.Add(250'000);
  record.sent.lateness.Add(0);
  EXPECT_EQ(LiveSummary({record}, {{24, 0}}, true),
            "front: 3 frames, 1 late; 12 datagrams, 16800 bytes; to receivers 24 sent, 0 refused\n"
            "                   p50       p95       p99       max\n"
            "  compute        2.014     5.000     5.000     5.000 ms\n"
            "  send           0.250     0.250     0.250     0.250 ms\n"
            "  lateness       0.000     0.000     0.000     0.000 ms\n");
  EXPECT_EQ(LiveSummary({record}, {{24, 0}}, false),
            "front: 3 frames, 1 late; 12 datagrams, 16800 bytes; to receivers 24 sent, 0 "
            "refused\n");
}

TEST(LiveSummary, NamesOnlySensorsThatHaveAName) {
  const LiveRecord record{.name = "", .frames = 9};
  EXPECT_EQ(LiveSummary({record}, {{0, 0}}, false),
            "9 frames, 0 late; 0 datagrams, 0 bytes; to receivers 0 sent, 0 refused\n");
}

TEST(LiveSummary, TellsDroppedFramesWhereThereAreAny) {
  const LiveRecord record{.name = "front", .frames = 3, .late_frames = 2, .dropped_frames = 4};
  EXPECT_EQ(LiveSummary({record}, {{0, 0}}, false),
            "front: 3 frames, 2 late, 4 dropped; 0 datagrams, 0 bytes; to receivers 0 sent, 0 "
            "refused\n");
}

TEST(LiveSummaryJson, IsOneLineOfTheSameNumbers) {
  LiveRecord record{.name = "front", .period_ns = 100'000'000, .frames = 3, .late_frames = 2};
  record.dropped_frames = 4;
  for (const std::int64_t ms : {2, 2, 5}) record.compute.Add(ms * 1'000'000);
  record.sent.datagrams = 12;
  record.sent.bytes = 16'800;
  const auto parsed = [&](const LiveResult& result, bool has_times) {
    const std::string text = LiveSummaryJson("stream", result, {{24, 1}},
                                             {"a.pcap: no space left on device"}, has_times);
    EXPECT_EQ(text.find('\n'), text.size() - 1);
    return nlohmann::json::parse(text);
  };
  const nlohmann::json summary = parsed({{record}, std::nullopt}, true);
  EXPECT_EQ(summary.at("command"), "stream");
  EXPECT_TRUE(summary.at("fault").is_null());
  EXPECT_TRUE(summary.at("log_fault").is_null());
  EXPECT_EQ(summary.at("capture_faults"),
            nlohmann::json::array({"a.pcap: no space left on device"}));
  const nlohmann::json& front = summary.at("sensors").at(0);
  for (const auto& [key, value] :
       {std::pair{"frames", 3}, std::pair{"late_frames", 2}, std::pair{"dropped_frames", 4},
        std::pair{"datagrams", 12}, std::pair{"bytes", 16'800}, std::pair{"sent_to_receivers", 24},
        std::pair{"refused", 1}}) {
    EXPECT_EQ(front.at(key), value) << key;
  }
  EXPECT_EQ(front.at("compute_ms").at("max"), 5.0);
  EXPECT_EQ(front.at("compute_ms").at("p50"),
            static_cast<double>(record.compute.QuantileNs(0.5)) / 1e6);
  const nlohmann::json untimed = parsed({{record}, "the line ends", "l: file too large"}, false);
  EXPECT_EQ(untimed.at("log_fault"), "l: file too large");
  EXPECT_EQ(untimed.at("fault"), "the line ends");
  EXPECT_TRUE(untimed.at("sensors").at(0).at("lateness_ms").is_null());
}

TEST(LiveSummary, TellsWhatWasCertifiedIfAnythingIsToBe) {
  LiveRecord record{.name = "front", .frames = 3};
  record.uncertified_frames = 2;
  record.certify.Add(1'000'000);
  record.certificate = RunCertificate{.cost_share = 0.01, .frames = 1, .firings = 900, .drawn = 4};
  const std::string text = LiveSummary({record}, {{0, 0}}, true);
  EXPECT_TRUE(text.ends_with(
      "  certify        1.000     1.000     1.000     1.000 ms\n"
      "certificate: too few echoes were drawn to tell; 4 of 900 firings were made anew on rung "
      "reference\n"
      "  only more frames would tell the share of missed echoes to +-5 points\n"
      "  2 of 3 frames were not certified for want of time\n"))
      << text;
  const auto front =
      nlohmann::json::parse(LiveSummaryJson("stream", {{record}, std::nullopt}, {{0, 0}}, {}, true))
          .at("sensors")
          .at(0);
  EXPECT_EQ(front.at("uncertified_frames"), 2);
  EXPECT_EQ(front.at("certify_ms").at("max"), 1.0);
  EXPECT_EQ(front.at("certificate").at("drawn"), 4);
}

TEST(LateText, CountsAllSensorsAndIsEmptyIfAllWasInTime) {
  EXPECT_EQ(LateText({{.frames = 3}, {.frames = 4}}), "");
  EXPECT_EQ(LateText({{.frames = 3, .late_frames = 1}, {.frames = 4, .late_frames = 2}}),
            "3 of 7 frames late");
  EXPECT_EQ(LateText({{.frames = 3, .dropped_frames = 5}}), "0 of 3 frames late, 5 dropped");
}

TEST(LiveProgress, IsOneLine) {
  const std::vector<LiveRecord> one = {{.frames = 1}};
  EXPECT_EQ(LiveProgress({12'300'000'000, 0, 999'999'999, one}), "12.3 s, 1 frame, 0 late");
  const std::vector<LiveRecord> two = {{.frames = 20, .late_frames = 2, .dropped_frames = 1},
                                       {.frames = 10, .late_frames = 3, .dropped_frames = 3}};
  EXPECT_EQ(LiveProgress({2'000'000'000, 0, 3'200'000'000, two}),
            "2.0 s, 20 frames, 5 late, 4 dropped, 3.2 s behind");
}

std::vector<LiveRecord> Records(std::uint64_t made, std::uint64_t late, std::uint64_t dropped) {
  return {{.frames = made, .late_frames = late, .dropped_frames = dropped}};
}

TEST(LagReport, SaysNothingOfARunThatKeepsUp) {
  for (const bool drops_late : {false, true}) {
    LagReport report(drops_late);
    for (std::int64_t i = 0; i < 1000; ++i) {
      const auto records = Records(static_cast<std::uint64_t>(i), 0, 0);
      EXPECT_EQ(report.After({i * kNsPerS, i * kNsPerS, kNsPerS - 1, records}), std::nullopt);
    }
  }
}

TEST(LagReport, SaysThatARunIsASecondBehind) {
  LagReport report(false);
  const auto records = Records(90, 79, 0);
  EXPECT_EQ(report.After({12'300'000'000, 15 * kNsPerS, 3'200'000'000, records}),
            "cannot keep up: 3.2 s behind after 12.3 s, 79 of 90 frames late; --drop-late drops "
            "frames instead");
}

TEST(LagReport, SaysThatFramesAreDropped) {
  LagReport report(true);
  const auto records = Records(90, 3, 38);
  EXPECT_EQ(report.After({12'300'000'000, 15 * kNsPerS, 0, records}),
            "cannot keep up: 38 of 128 frames dropped after 12.3 s");
  // No further frames were dropped.
  EXPECT_EQ(report.After({12'300'000'000, 100 * kNsPerS, 0, records}), std::nullopt);
}

TEST(LagReport, SaysSoAtMostEveryTenSeconds) {
  LagReport behind(false);
  LagReport dropping(true);
  for (std::int64_t i = 0; i < 600; ++i) {  // One minute in steps of 0.1 s.
    const auto records = Records(1, 1, static_cast<std::uint64_t>(i) + 1);
    const RunState state{i * kNsPerS / 10, i * kNsPerS / 10, 2 * kNsPerS, records};
    EXPECT_EQ(behind.After(state).has_value(), i % 100 == 0) << i;
    EXPECT_EQ(dropping.After(state).has_value(), i % 100 == 0) << i;
  }
}

}  // namespace

}  // namespace railcast
