#include <gtest/gtest.h>

#include "analysis/compare/distance_bins.h"
#include "analysis/compare/histogram.h"
#include "analysis/stats/bins.h"
#include "tests/analysis/compare/made_clouds.h"

namespace railcast {
namespace {

TEST(JensenShannonDivergence, IsZeroOfTheSameAndOneOfNothingInCommon) {
  const Histogram some({1, 1, 2, 5});
  // The divergence depends on shares, not on counts.
  EXPECT_EQ(JensenShannonDivergence(some, Histogram({1, 1, 1, 1, 2, 2, 5, 5})), 0.0);
  EXPECT_NEAR(JensenShannonDivergence(some, Histogram({3, 4})), 1.0, 1e-12);
}

TEST(JensenShannonDivergence, IsWhatItsFormulaSays) {
  // Distributions (1, 0) and (1/2, 1/2): H(3/4, 1/4) - 1/2.
  const double expected = -0.75 * std::log2(0.75) - 0.25 * std::log2(0.25) - 0.5;
  EXPECT_NEAR(JensenShannonDivergence(Histogram({7}), Histogram({7, 9})), expected, 1e-12);
  EXPECT_NEAR(JensenShannonDivergence(Histogram({7, 9}), Histogram({7})), expected, 1e-12);
}

TEST(JensenShannonDivergence, IsNotKnownOfNothing) {
  EXPECT_TRUE(std::isnan(JensenShannonDivergence(Histogram(), Histogram({1}))));
  EXPECT_TRUE(std::isnan(JensenShannonDivergence(Histogram({1}), Histogram())));
}

TEST(Histogram, AddsUp) {
  Histogram sum({5, -3, 5});
  sum.Add(Histogram({-3, 8}));
  const std::vector<std::pair<std::int64_t, std::uint64_t>> expected = {{-3, 2}, {5, 2}, {8, 1}};
  EXPECT_EQ(sum.counts(), expected);
  EXPECT_EQ(sum.num(), 5U);
}

TEST(CloudHistograms, CountACellOnceHoweverManyPointsItHolds) {
  const CloudHistograms found =
      HistogramsOf(MadeCloud({{1.1F, 2.1F, 0}, {1.9F, 2.9F, 5}, {-0.1F, 2.5F, 0}}));
  EXPECT_EQ(found.occupancy.num(), 2U);
  EXPECT_EQ(found.range.num(), 3U);
  EXPECT_EQ(found.ring.num(), 3U);
}

TEST(CloudHistograms, PutAnyIntensityIntoABinNearIt) {
  for (const float intensity : {0.002F, 0.1F, 0.5F, 1.0F, 37.0F, 255.0F}) {
    const CloudHistograms found = HistogramsOf(MadeCloud({{1, 0, 0, intensity}}));
    const double middle = IntensityOfBin(found.intensity.counts()[0].first);
    EXPECT_NEAR(middle / static_cast<double>(intensity), 1.0, 0.05) << intensity;
  }
}

TEST(CloudHistograms, LeaveOutIntensitiesThatAreNone) {
  const CloudHistograms found =
      HistogramsOf(MadeCloud({{1, 0, 0, std::numeric_limits<float>::quiet_NaN()}}));
  EXPECT_EQ(found.intensity.num(), 0U);
}

// Adds `num` points around `range_m` ahead of the sensor.
void AddPoints(std::vector<MadePoint>& points, int num, float range_m, float intensity) {
  for (int i = 0; i < num; ++i)
    points.push_back({range_m, 0.001F * static_cast<float>(i), 0, intensity});
}

TEST(BinErrors, AreTheMeanOverBinsInPercent) {
  std::vector<MadePoint> a, b;
  AddPoints(a, 100, 12.0F, 0.5F);
  AddPoints(b, 90, 12.0F, 0.6F);
  AddPoints(a, 50, 35.0F, 0.2F);
  AddPoints(b, 60, 35.0F, 0.1F);
  const BinErrors errors = ErrorsOf(BinnedByRange(MadeCloud(a)), BinnedByRange(MadeCloud(b)));
  EXPECT_NEAR(errors.points, (10.0 + 20.0) / 2.0, 1e-9);
  EXPECT_NEAR(errors.intensity, (20.0 + 50.0) / 2.0, 1e-4);
}

TEST(BinErrors, LeaveOutBinsWithTooFewPointsOfTheReference) {
  std::vector<MadePoint> a, b;
  AddPoints(a, 9, 12.0F, 0.5F);
  AddPoints(b, 90, 12.0F, 0.5F);
  const BinErrors errors = ErrorsOf(BinnedByRange(MadeCloud(a)), BinnedByRange(MadeCloud(b)));
  EXPECT_TRUE(std::isnan(errors.points));
  EXPECT_TRUE(std::isnan(errors.intensity));
}

TEST(BinErrors, AreHundredPercentWhereAllIsMissing) {
  std::vector<MadePoint> a;
  AddPoints(a, 20, 12.0F, 0.5F);
  const BinErrors errors = ErrorsOf(BinnedByRange(MadeCloud(a)), BinnedByRange(MadeCloud({})));
  EXPECT_EQ(errors.points, 100.0);
  EXPECT_TRUE(std::isnan(errors.intensity));
}

TEST(BinSums, WantTenPairsForAnInterval) {
  std::vector<MadePoint> a, b;
  AddPoints(a, 100, 12.0F, 0.5F);
  AddPoints(b, 90, 12.0F, 0.5F);
  const std::size_t bin = RangeBins().Find(12.0).value();
  BinSums sums;
  for (int i = 0; i < 9; ++i) sums.Add(BinnedByRange(MadeCloud(a)), BinnedByRange(MadeCloud(b)));
  EXPECT_FALSE(sums.bins()[bin].points_change.Mean().is_enough());
  sums.Add(BinnedByRange(MadeCloud(a)), BinnedByRange(MadeCloud(b)));
  EXPECT_NEAR(sums.bins()[bin].points_change.Mean().value, -0.1, 1e-12);
  EXPECT_NEAR(sums.Errors().points, 10.0, 1e-9);
}

}  // namespace
}  // namespace railcast
