#include "core/program/duration_histogram.h"

#include <gtest/gtest.h>

namespace railcast {
namespace {

TEST(DurationHistogram, TellsQuantilesToOnePercent) {
  DurationHistogram histogram;
  for (std::int64_t i = 1; i <= 1000; ++i) histogram.Add(i * 1'000'000);
  EXPECT_EQ(histogram.count(), 1000U);
  EXPECT_EQ(histogram.max_ns(), 1'000'000'000);
  for (const double fraction : {0.01, 0.5, 0.95, 0.99}) {
    const double exact_ns = fraction * 1e9;
    EXPECT_NEAR(static_cast<double>(histogram.QuantileNs(fraction)), exact_ns, 0.0101 * exact_ns);
  }
}

TEST(DurationHistogram, NeverExceedsTheMaximum) {
  DurationHistogram histogram;
  histogram.Add(123'456'789);
  EXPECT_EQ(histogram.QuantileNs(0.5), 123'456'789);
  EXPECT_EQ(histogram.QuantileNs(1.0), 123'456'789);
}

TEST(DurationHistogram, TakesWhatIsNegativeHugeOrAbsent) {
  DurationHistogram histogram;
  EXPECT_EQ(histogram.QuantileNs(0.99), 0);
  histogram.Add(-5);
  EXPECT_EQ(histogram.QuantileNs(0.99), 0);
  histogram.Add(INT64_MAX);
  EXPECT_EQ(histogram.max_ns(), INT64_MAX);
  EXPECT_EQ(histogram.count(), 2U);
}

}  // namespace
}  // namespace railcast
