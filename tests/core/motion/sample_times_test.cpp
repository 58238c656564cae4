#include "core/motion/sample_times.h"

#include <gtest/gtest.h>

#include <cstdint>

namespace railcast {
namespace {

TEST(SampleTimes, AreWholeNanosecondsFromTimeZero) {
  EXPECT_EQ(SampleTimeNs(0, 100.0), 0);
  EXPECT_EQ(SampleTimeNs(1, 100.0), 10'000'000);
  EXPECT_EQ(SampleTimeNs(2, 3.0), 666'666'667);
  // A day at 200 Hz.
  EXPECT_EQ(SampleTimeNs(17'280'000, 200.0), 86'400'000'000'000);
}

TEST(SampleTimes, ATimeBelongsToTheSpanThatItBegins) {
  const SampleRange range = SamplesBetween(100'000'000, 200'000'000, 100.0);
  EXPECT_EQ(range.begin, 10U);
  EXPECT_EQ(range.end, 20U);
  EXPECT_EQ(SamplesBetween(100'000'001, 200'000'001, 100.0).begin, 11U);
  EXPECT_EQ(SamplesBetween(100'000'001, 200'000'001, 100.0).end, 21U);
}

// Rates that divide neither one another nor a second.
TEST(SampleTimes, SpansShareOutAllSamplesWithoutGapsOrRepetitions) {
  for (const double rate_hz : {0.7, 1.0, 3.0, 99.9, 400.0}) {
    std::uint64_t next = 0;
    std::int64_t begin_ns = 0;
    for (int span = 0; span < 1000; ++span) {
      const std::int64_t end_ns = begin_ns + 76'923'077 + span % 2;
      const SampleRange range = SamplesBetween(begin_ns, end_ns, rate_hz);
      ASSERT_EQ(range.begin, next) << rate_hz << " Hz, span " << span;
      for (std::uint64_t sample = range.begin; sample < range.end; ++sample) {
        ASSERT_GE(SampleTimeNs(sample, rate_hz), begin_ns);
        ASSERT_LT(SampleTimeNs(sample, rate_hz), end_ns);
      }
      next = range.end;
      begin_ns = end_ns;
    }
    EXPECT_NEAR(static_cast<double>(next), 76.9230775 * rate_hz, 1.0);
  }
}

}  // namespace
}  // namespace railcast
