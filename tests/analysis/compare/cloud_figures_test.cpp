#include "analysis/compare/cloud_figures.h"

#include <gtest/gtest.h>
#include <pcl/io/pcd_io.h>

#include <cstdlib>
#include <sstream>

#include "analysis/stats/bins.h"
#include "analysis/stats/sums.h"
#include "tests/analysis/compare/made_clouds.h"
#include "tests/core/scenario/scenario_files.h"
#include "tests/support/run_command.h"

namespace railcast {
namespace {

const std::vector<double> kBinEnds_m = {0.05, 0.2};

pcl::PointCloud<pcl::PointXYZ> PclCloud(const std::vector<Eigen::Vector3f>& points_m) {
  pcl::PointCloud<pcl::PointXYZ> cloud;
  for (const Eigen::Vector3f& p : points_m) cloud.emplace_back(p.x(), p.y(), p.z());
  return cloud;
}

CloudDistances Distances(const std::vector<MadePoint>& a, const std::vector<MadePoint>& b) {
  return DistancesOf(MadeCloud(a), MadeCloud(b), kBinEnds_m).value();
}

TEST(CloudDistances, AreNoneBetweenIdenticalClouds) {
  const CloudDistances same = Distances(MadePlane(0.0F), MadePlane(0.0F));
  EXPECT_EQ(same.chamfer_m, 0.0);
  EXPECT_EQ(same.chamfer_squares_m2, 0.0);
  EXPECT_EQ(same.hausdorff_m, 0.0);
  EXPECT_EQ(same.hausdorff95_m, 0.0);
  EXPECT_EQ(same.density_aware, 0.0);
  EXPECT_EQ(same.within[0].f_score, 1.0);
}

TEST(CloudDistances, OfAShiftedPlaneAreItsShift) {
  const double shift_m = 0.1;
  const double tolerance_m = 1e-6;  // Precision of float32 at 20 m.
  const CloudDistances shifted = Distances(MadePlane(0.0F), MadePlane(0.1F));
  EXPECT_NEAR(shifted.a_to_b_m, shift_m, tolerance_m);
  EXPECT_NEAR(shifted.chamfer_m, shift_m, tolerance_m);
  EXPECT_NEAR(shifted.chamfer_squares_m2, 2.0 * shift_m * shift_m, tolerance_m);
  EXPECT_NEAR(shifted.hausdorff_m, shift_m, tolerance_m);
  EXPECT_NEAR(shifted.hausdorff95_m, shift_m, tolerance_m);
  EXPECT_NEAR(shifted.density_aware, 1.0 - std::exp(-kDensityAwareAlpha_per_m * shift_m), 1e-5);
  EXPECT_EQ(shifted.within[0].f_score, 0.0);
  EXPECT_EQ(shifted.within[1].f_score, 1.0);
}

TEST(CloudDistances, TellPrecisionFromRecall) {
  // B contains A and the same number of points far above it.
  std::vector<MadePoint> b = MadePlane(0.0F);
  for (const MadePoint& point : MadePlane(10.0F)) b.push_back(point);
  const CloudDistances found = Distances(MadePlane(0.0F), b);
  EXPECT_EQ(found.within[0].recall, 1.0);
  EXPECT_EQ(found.within[0].precision, 0.5);
  EXPECT_NEAR(found.within[0].f_score, 2.0 / 3.0, 1e-12);
  EXPECT_EQ(found.a_to_b_m, 0.0);
  EXPECT_NEAR(found.b_to_a_m, 5.0, 1e-6);
  EXPECT_NEAR(found.chamfer_m, 2.5, 1e-6);
  EXPECT_NEAR(found.hausdorff_m, 10.0, 1e-6);
}

TEST(CloudDistances, LeaveTheOutermostTwentiethToTheHausdorffDistance) {
  std::vector<MadePoint> b = MadePlane(0.0F);
  // 20 of 420 points are less than 5 %.
  for (int i = 0; i < 20; ++i) b.push_back({static_cast<float>(i), 0.0F, 50.0F});
  const CloudDistances found = Distances(MadePlane(0.0F), b);
  EXPECT_NEAR(found.hausdorff_m, 50.0, 1e-5);
  EXPECT_EQ(found.hausdorff95_m, 0.0);
}

TEST(CloudDistances, CountDensityWhereChamferDoesNot) {
  // Every point of B is there twice: each point of A has its own nearest point, but two points of B
  // share one.
  std::vector<MadePoint> twice = MadePlane(0.0F);
  for (const MadePoint& point : MadePlane(0.0F)) twice.push_back(point);
  const CloudDistances found = Distances(MadePlane(0.0F), twice);
  EXPECT_EQ(found.chamfer_m, 0.0);
  EXPECT_NEAR(found.density_aware, 0.5 * (0.0 + 0.5), 1e-12);
}

TEST(CloudDistances, AreNotKnownWithoutPoints) {
  const float none = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(DistancesOf(MadeCloud({}), MadeCloud(MadePlane(0.0F)), kBinEnds_m));
  EXPECT_FALSE(DistancesOf(MadeCloud(MadePlane(0.0F)), MadeCloud({}), kBinEnds_m));
  EXPECT_FALSE(DistancesOf(MadeCloud({{none, none, none}}), MadeCloud({{1, 2, none}}), kBinEnds_m));
}

TEST(CloudDistances, AreOfTwoSinglePointsTheirDistance) {
  const CloudDistances found = Distances({{0, 0, 0}}, {{3, 4, 0}});
  EXPECT_EQ(found.chamfer_m, 5.0);
  EXPECT_EQ(found.hausdorff95_m, 5.0);
}

TEST(CloudDistances, GrowWithNoise) {
  double chamfer_m = 0.0, density_aware = 0.0, f_score = 1.1;
  for (const double sigma_m : {0.01, 0.02, 0.05, 0.1, 0.2}) {
    const CloudDistances found = Distances(MadePlane(0.0F), WithNoise(MadePlane(0.0F), sigma_m));
    EXPECT_GT(found.chamfer_m, chamfer_m) << sigma_m;
    EXPECT_GT(found.density_aware, density_aware) << sigma_m;
    EXPECT_LE(found.within[1].f_score, f_score) << sigma_m;
    chamfer_m = found.chamfer_m;
    density_aware = found.density_aware;
    f_score = found.within[1].f_score;
  }
  // 0.2 m is far less than half the spacing of the points; the mean length of the noise is
  // 2 sqrt(2 / pi) sigma.
  EXPECT_NEAR(chamfer_m, 2.0 * std::sqrt(2.0 / std::numbers::pi) * 0.2, 0.02);
}

// Compares the mean and largest distance in both directions with those of Open3D.
TEST(CloudDistances, AreThoseOfOpen3d) {
  if (std::system("/usr/bin/python3 -c 'import open3d' >/dev/null 2>&1") != 0) {
    GTEST_SKIP() << "python3-open3d is not installed";
  }
  const TemporaryFolder folder;
  const ComparedCloud a = MadeCloud(WithNoise(MadePlane(0.0F), 0.4));
  const ComparedCloud b = MadeCloud(WithNoise(MadePlane(0.3F), 0.7));
  const auto file_a = folder.Write("a.pcd", ""), file_b = folder.Write("b.pcd", "");
  pcl::io::savePCDFileBinary(file_a.string(), PclCloud(a.points_m));
  pcl::io::savePCDFileBinary(file_b.string(), PclCloud(b.points_m));
  const Ended ended = RunCommand(
      "/usr/bin/python3 -c \"import open3d as o, numpy as n; a, b = (o.io.read_point_cloud(f) for "
      "f "
      "in ('" +
      file_a.string() + "', '" + file_b.string() +
      "')); p, q = (n.asarray(x) for x in (a.compute_point_cloud_distance(b), "
      "b.compute_point_cloud_distance(a))); print(p.mean(), q.mean(), max(p.max(), q.max()), "
      "(p <= 0.2).mean(), (q <= 0.2).mean())\" 2>/dev/null");
  std::istringstream said(ended.said);
  double a_to_b_m{}, b_to_a_m{}, hausdorff_m{}, recall{}, precision{};
  ASSERT_TRUE(said >> a_to_b_m >> b_to_a_m >> hausdorff_m >> recall >> precision) << ended.said;
  const CloudDistances found = DistancesOf(a, b, kBinEnds_m).value();
  EXPECT_NEAR(found.a_to_b_m, a_to_b_m, 1e-6);
  EXPECT_NEAR(found.b_to_a_m, b_to_a_m, 1e-6);
  EXPECT_NEAR(found.hausdorff_m, hausdorff_m, 1e-6);
  EXPECT_NEAR(found.within[1].recall, recall, 1e-12);
  EXPECT_NEAR(found.within[1].precision, precision, 1e-12);
}

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
  AddTo(sum, Histogram({-3, 8}));
  const std::map<std::int64_t, std::uint64_t> expected = {{-3, 2}, {5, 2}, {8, 1}};
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
    const double middle = IntensityOfBin(found.intensity.counts().begin()->first);
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

TEST(BinErrors, OfVelocitiesAreTheMeanDifferenceOfBins) {
  std::vector<MadePoint> a, b;
  AddPoints(a, 20, 12.0F, 0.5F);
  AddPoints(a, 20, 35.0F, 0.5F);
  b = a;
  // In A all stands; in B half of the near points come, and all of the far ones recede.
  for (std::size_t i = 0; i < b.size(); ++i) {
    b[i].velocity_mps = i >= 20 ? 1.5F : i % 2 == 0 ? -9.0F : 0.0F;
  }
  const BinnedCloud bins_a = BinnedByRange(MadeCloud(a));
  const BinnedCloud bins_b = BinnedByRange(MadeCloud(b));
  EXPECT_DOUBLE_EQ(ErrorsOf(bins_a, bins_b).velocity_mps, (4.5 + 1.5) / 2.0);
  BinSums sums;
  for (int i = 0; i < 10; ++i) sums.Add(bins_a, bins_b);
  const BinSums::Bin& near = sums.bins()[RangeBins().Find(12.0).value()];
  EXPECT_DOUBLE_EQ(near.velocity_a_mps.PlainMean(), 0.0);
  EXPECT_DOUBLE_EQ(near.velocity_b_mps.PlainMean(), -4.5);
  EXPECT_DOUBLE_EQ(near.velocity_change_mps.PlainMean(), -4.5);
}

TEST(BinErrors, OfVelocitiesWantTenInABin) {
  std::vector<MadePoint> a;
  AddPoints(a, 20, 12.0F, 0.5F);
  std::vector<MadePoint> b = a;
  for (std::size_t i = 0; i < 11; ++i) b[i].velocity_mps = NAN;
  const BinErrors errors = ErrorsOf(BinnedByRange(MadeCloud(a)), BinnedByRange(MadeCloud(b)));
  EXPECT_TRUE(std::isnan(errors.velocity_mps));
  EXPECT_EQ(errors.points, 0.0);
}

TEST(CloudHistograms, PutVelocitiesIntoBinsOfOneMetrePerSecond) {
  using Counts = std::map<std::int64_t, std::uint64_t>;
  const std::vector<MadePoint> points = {{1, 0, 0, 0.5F, 0, -0.5F},
                                         {2, 0, 0, 0.5F, 0, 0.0F},
                                         {3, 0, 0, 0.5F, 0, 0.99F},
                                         {4, 0, 0, 0.5F, 0, NAN},
                                         {5, 0, 0, 0.5F, 0, 1e30F}};
  EXPECT_EQ(HistogramsOf(MadeCloud(points)).velocity.counts(),
            (Counts{{-1, 1}, {0, 2}, {1'000'000, 1}}));
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
