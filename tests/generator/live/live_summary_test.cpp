#include "generator/live/live_summary.h"

#include <gtest/gtest.h>

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

TEST(LiveSummary, TellsDroppedFramesWhereThereAreAny) {
  const LiveRecord record{.name = "front", .frames = 3, .late_frames = 2, .dropped_frames = 4};
  EXPECT_EQ(LiveSummary({record}, {{0, 0}}, false),
            "front: 3 frames, 2 late, 4 dropped; 0 datagrams, 0 bytes; to receivers 0 sent, 0 "
            "refused\n");
}

TEST(LiveProgress, IsOneLine) {
  const std::vector<LiveRecord> one = {{.frames = 1}};
  EXPECT_EQ(LiveProgress({12'300'000'000, 0, 999'999'999, one}), "12.3 s, 1 frame, 0 late");
  const std::vector<LiveRecord> two = {{.frames = 20, .late_frames = 2, .dropped_frames = 1},
                                       {.frames = 10, .late_frames = 3, .dropped_frames = 3}};
  EXPECT_EQ(LiveProgress({2'000'000'000, 0, 3'200'000'000, two}),
            "2.0 s, 20 frames, 5 late, 4 dropped, 3.2 s behind");
}

}  // namespace
}  // namespace railcast
