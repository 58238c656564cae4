#include "generator/live/lag_report.h"

#include <gtest/gtest.h>

#include <vector>

#include "core/base/units.h"
namespace railcast {
namespace {

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
