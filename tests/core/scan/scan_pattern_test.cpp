#include "railcast/lidar.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "railcast/error.h"
#include "tests/core/io/message_of.h"

namespace railcast {
namespace {

std::int64_t StampNs(double rate_hz, std::uint32_t frame_index) {
  ScanPattern pattern;
  pattern.rate_hz = rate_hz;
  return pattern.StampNs(frame_index);
}

TEST(ScanPattern, StampsFramesOnePeriodApart) {
  EXPECT_EQ(StampNs(10.0, 0), 0);
  EXPECT_EQ(StampNs(10.0, 1), 100'000'000);
  EXPECT_EQ(StampNs(10.0, 36000), 3'600'000'000'000);
}

TEST(ScanPattern, StampsDoNotDriftWhereThePeriodIsNoWholeNumberOfNanoseconds) {
  EXPECT_EQ(StampNs(3.0, 1), 333'333'333);
  EXPECT_EQ(StampNs(3.0, 2), 666'666'667);
  EXPECT_EQ(StampNs(3.0, 3'000'000'000), 1'000'000'000'000'000'000);
}

TEST(ScanPattern, StampsAreExactForBrokenRates) {
  EXPECT_EQ(StampNs(12.5, 1), 80'000'000);
  EXPECT_EQ(StampNs(12.5, 4'000'000'001), 320'000'000'080'000'000);
  EXPECT_EQ(StampNs(0.5, std::numeric_limits<std::uint32_t>::max()), 8'589'934'590'000'000'000);
}

TEST(ScanPattern, StampsFramesFromThePhaseOn) {
  const ScanPattern pattern =
      BuildScanPattern({.rate_hz = 3.0, .pattern = RasterSpec{10.0, 10.0, 1.0}, .phase_s = 0.25});
  EXPECT_EQ(pattern.StampNs(0), 250'000'000);
  EXPECT_EQ(pattern.StampNs(1), 583'333'333);
  EXPECT_EQ(pattern.PeriodNs(), 333'333'333);
}

TEST(ScanPattern, BeginsWithinItsFirstPeriod) {
  const auto error_of = [](double phase_s) -> std::string {
    return MessageOf([&] {
      static_cast<void>(BuildScanPattern(
          {.rate_hz = 4.0, .pattern = RasterSpec{10.0, 10.0, 1.0}, .phase_s = phase_s}));
    });
  };
  EXPECT_EQ(error_of(0.25), "/phase_s: must be >= 0 and < 1 / rate_hz (got 0.25)");
  EXPECT_EQ(error_of(-0.01), "/phase_s: must be >= 0 and < 1 / rate_hz (got -0.01)");
}

TEST(ScanPattern, NamesTheLastFrameWhoseTimesFitInto64Bits) {
  constexpr std::uint32_t kMost = std::numeric_limits<std::uint32_t>::max();
  ScanPattern pattern;
  pattern.rate_hz = 10.0;
  EXPECT_EQ(pattern.LastFrame(), kMost);
  pattern.rate_hz = 0.125;
  // 2^63 - 2^32 ns are 9223372032.56 s.
  EXPECT_EQ(pattern.LastFrame(), 1'152'921'504U);
  EXPECT_EQ(pattern.StampNs(1'152'921'504), 9'223'372'032'000'000'000);
}

}  // namespace
}  // namespace railcast
