#include <gtest/gtest.h>

#include <cmath>

#include "tests/core/scan/pattern_angles.h"

namespace railcast {
namespace {

ScanSpec Published() {
  return {
      .rate_hz = 10.0,
      .pattern = RasterSpec{
          .horizontal_fov_deg = 60.0, .vertical_fov_deg = 30.0, .angular_resolution_deg = 0.25}};
}

TEST(RasterPattern, HasThePublishedNumberOfBeams) {
  const ScanPattern pattern = BuildScanPattern(Published());
  EXPECT_EQ(pattern.rows, 120U);
  EXPECT_EQ(pattern.columns, 240U);
  EXPECT_EQ(pattern.num_firings(), 28800U);
}

TEST(RasterPattern, AimsThroughTheCentresOfTheCells) {
  const ScanPattern pattern = BuildScanPattern(Published());
  for (std::size_t i = 0; i < pattern.num_firings(); ++i) {
    ASSERT_NEAR(AzimuthInDegrees(pattern, i), 29.875 - 0.25 * pattern.column[i], kFloatAngle_deg);
    ASSERT_NEAR(ElevationInDegrees(pattern, i), -14.875 + 0.25 * pattern.row[i], kFloatAngle_deg);
  }
}

TEST(RasterPattern, FiresColumnsEvenlyOverThePeriodAndRowsTogether) {
  const ScanPattern pattern = BuildScanPattern(Published());
  for (std::size_t i = 0; i < pattern.num_firings(); ++i) {
    ASSERT_EQ(pattern.column[i], i / 120);
    ASSERT_EQ(pattern.row[i], i % 120);
    ASSERT_EQ(pattern.time_ns[i], std::lround(1e8 * pattern.column[i] / 240));
  }
  EXPECT_EQ(pattern.time_ns.back(), 99583333U);
}

TEST(RasterPattern, FiresRowsFromTheBottomWhereAskedTo) {
  ScanSpec spec = Published();
  std::get<RasterSpec>(spec.pattern).order = RasterOrder::kRows;
  const ScanPattern pattern = BuildScanPattern(spec);
  for (std::size_t i = 0; i < pattern.num_firings(); ++i) {
    ASSERT_EQ(pattern.row[i], i / 240);
    ASSERT_EQ(pattern.column[i], i % 240);
    ASSERT_EQ(pattern.time_ns[i], std::lround(1e8 * pattern.row[i] / 120));
  }
}

TEST(RasterPattern, HasDirectionsOfUnitLength) {
  const ScanPattern pattern = BuildScanPattern(Published());
  for (std::size_t i = 0; i < pattern.num_firings(); ++i) {
    ASSERT_NEAR(Direction(pattern, i).squaredNorm(), 1.0,
                1.2e-7);  // 2 x three roundings of at most 2^-25.
  }
}

TEST(RasterPattern, AcceptsDecimalResolutionsThatDivideTheFieldOfView) {
  const ScanPattern pattern = BuildScanPattern(
      {.rate_hz = 25.0,
       .pattern = RasterSpec{
           .horizontal_fov_deg = 360.0, .vertical_fov_deg = 0.3, .angular_resolution_deg = 0.1}});
  EXPECT_EQ(pattern.columns, 3600U);
  EXPECT_EQ(pattern.rows, 3U);
}

TEST(RasterPattern, RefusesCellsThatAreNotWhole) {
  EXPECT_EQ(
      FaultsOf({.rate_hz = 10.0,
                .pattern = RasterSpec{.horizontal_fov_deg = 60.0,
                                      .vertical_fov_deg = 30.0,
                                      .angular_resolution_deg = 0.8}}),
      "/pattern/vertical_fov_deg: must be a whole number of angular_resolution_deg (got 37.5)");
}

TEST(RasterPattern, ReportsEveryFaultAtOnce) {
  EXPECT_EQ(FaultsOf({.rate_hz = 0.0,
                      .pattern = RasterSpec{.horizontal_fov_deg = 361.0,
                                            .vertical_fov_deg = -1.0,
                                            .angular_resolution_deg = 0.25}}),
            "/rate_hz: must be >= 0.01 and <= 1000000 (got 0)\n"
            "/pattern/horizontal_fov_deg: must be > 0 and <= 360 (got 361)\n"
            "/pattern/vertical_fov_deg: must be > 0 and <= 180 (got -1)");
  EXPECT_EQ(FaultsOf({.rate_hz = 10.0,
                      .pattern = RasterSpec{.horizontal_fov_deg = 60.0,
                                            .vertical_fov_deg = 30.0,
                                            .angular_resolution_deg = std::nan("")}}),
            "/pattern/angular_resolution_deg: must be > 0 (got nan)");
}

TEST(RasterPattern, RefusesHugePatterns) {
  EXPECT_EQ(FaultsOf({.rate_hz = 10.0,
                      .pattern = RasterSpec{.horizontal_fov_deg = 360.0,
                                            .vertical_fov_deg = 180.0,
                                            .angular_resolution_deg = 0.0001}}),
            "/pattern/vertical_fov_deg: must have at most 65536 cells (got 1800000)\n"
            "/pattern: must have at most 16777216 firings (got 6.48e+12)");
}

TEST(RasterPattern, RefusesFramesLongerThan32BitsOfNanoseconds) {
  ScanSpec spec = Published();
  spec.rate_hz = 0.2;
  EXPECT_EQ(FaultsOf(spec), "/pattern: the last firing must come before 4.29 s (got 4.979166667)");
}

}  // namespace
}  // namespace railcast
