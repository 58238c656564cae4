#include "generator/extras/replay/replay_feed.h"

#include <gtest/gtest.h>

#include <limits>

namespace railcast {
namespace {

constexpr std::int64_t kMilli_ns = 1'000'000;
constexpr std::int64_t kBegin_ns = 1'700'000'000'000'000'000;

TEST(ReplayTimes, PassAsRecordedOrFaster) {
  for (const double rate : {1.0, 4.0, 0.5}) {
    ReplayTimes times(rate);
    for (const std::int64_t ms : {0, 1, 100, 3'600'000}) {
      EXPECT_EQ(static_cast<double>(times.Of(kBegin_ns + ms * kMilli_ns)) * rate,
                static_cast<double>(ms * kMilli_ns));
    }
    EXPECT_EQ(static_cast<double>(times.Lasting(8 * kMilli_ns)) * rate, 8e6);
  }
}

TEST(ReplayTimes, SendWhatWasOvertakenAtOnce) {
  ReplayTimes times(1.0);
  EXPECT_EQ(times.Of(kBegin_ns), 0);
  EXPECT_EQ(times.Of(kBegin_ns + 10 * kMilli_ns), 10 * kMilli_ns);
  EXPECT_EQ(times.Of(kBegin_ns + 7 * kMilli_ns), 10 * kMilli_ns);
  EXPECT_EQ(times.Of(kBegin_ns + 9 * kMilli_ns), 10 * kMilli_ns);
  EXPECT_EQ(times.Of(kBegin_ns + 11 * kMilli_ns), 11 * kMilli_ns);
}

TEST(ReplayTimes, GoOnFromWhereAClockWasSetBack) {
  ReplayTimes times(2.0);
  EXPECT_EQ(times.Of(kBegin_ns), 0);
  EXPECT_EQ(times.Of(kBegin_ns + 10 * kMilli_ns), 5 * kMilli_ns);
  EXPECT_EQ(times.Of(kBegin_ns - 5'000 * kMilli_ns), 5 * kMilli_ns);
  EXPECT_EQ(times.Of(kBegin_ns - 4'996 * kMilli_ns), 7 * kMilli_ns);
}

TEST(ReplayTimes, StandAnyTime) {
  ReplayTimes times(1e-3);
  EXPECT_EQ(times.Of(std::numeric_limits<std::int64_t>::min()), 0);
  // That far is further than numbers can say, so it counts as a clock that was set.
  EXPECT_EQ(times.Of(std::numeric_limits<std::int64_t>::max()), 0);
  EXPECT_EQ(times.Of(0), 0);
  std::int64_t last_ns = 0;
  for (int i = 0; i < 3; ++i) {
    EXPECT_GE(times.Of(std::numeric_limits<std::int64_t>::max() / 2), last_ns);
    last_ns = times.Of(std::numeric_limits<std::int64_t>::max() / 2);
    static_cast<void>(times.Of(0));
  }
}

}  // namespace
}  // namespace railcast
