#include "analysis/stats/statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <variant>

#include "analysis/stats/bins.h"
#include "tests/analysis/recorded_frames.h"
#include "tests/core/simulate/measured_velocities.h"

namespace railcast {
namespace {

constexpr double kReceding_mps = 9.0;

/// A wall 25 m ahead that recedes, seen under up to 11 degrees, by a rung with or without noise.
Frame RecedingWall(const VelocitySpec& velocity, std::uint32_t index = 0) {
  SimulatorSpec spec = Measuring(velocity);
  spec.detector.effects.noise = velocity.sigma_mps > 0.0;
  return ScanOnce(WorldWithWallAt(25.0, {kReceding_mps, 0.0, 0.0}), MakeRaster(20.0, 10.0, 0.25),
                  spec, index);
}

const Velocity::Sum& SumAt(const Velocity& velocity, double range_m) {
  return velocity.by_range()[RangeBins().Find(range_m).value()];
}

TEST(VelocityStatistics, FindTheNoiseAndNoBias) {
  constexpr double kSigma_mps = 0.05;
  Velocity velocity;
  for (std::uint32_t i = 0; i < 10; ++i) {
    velocity.Add(Record(RecedingWall({.sigma_mps = kSigma_mps, .max_mps = 128.0}, i)));
  }
  const Velocity::Sum& sum = SumAt(velocity, 26.0);
  const auto num = static_cast<double>(sum.errors_mps.num());
  ASSERT_GT(num, 10'000.0);
  // Four standard errors: of a standard deviation 1 / sqrt(2 n), of the robust one sqrt(e) more.
  const double error = 4.0 / std::sqrt(2.0 * num);
  EXPECT_NEAR(sum.errors_mps.plain.StandardDeviation().value / kSigma_mps, 1.0, error);
  EXPECT_NEAR(sum.errors_mps.robust.RobustScale().value / kSigma_mps, 1.0, 1.65 * error + 0.01);
  EXPECT_NEAR(sum.errors_mps.plain.Mean().value, 0.0, 4.0 * kSigma_mps / std::sqrt(num));
}

TEST(VelocityStatistics, HaveTheMeanAndTheDistributionOfTheBeams) {
  const Frame frame = RecedingWall(kExact);
  std::map<std::int64_t, std::uint64_t> expected;
  double sum_mps = 0.0;
  const ScanPattern pattern = MakeRaster(20.0, 10.0, 0.25);
  ForEachFiring(frame, pattern, [&](std::size_t, const Vector3& direction, double) {
    const double along_mps = kReceding_mps * direction.x();
    sum_mps += along_mps;
    ++expected[static_cast<std::int64_t>(along_mps / kVelocityBin_mps)];
  });
  Velocity velocity;
  velocity.Add(Record(frame));
  EXPECT_EQ(velocity.distribution(), expected);
  // The wall recedes 0.9 m while the frame lasts; all of it is in the bin of 20 to 30 m.
  const Velocity::Sum& sum = SumAt(velocity, 26.0);
  EXPECT_EQ(sum.num_points, frame.num_slots());
  EXPECT_NEAR(sum.measured_mps.PlainMean(), sum_mps / static_cast<double>(frame.num_slots()),
              kRounding_mps);
}

TEST(VelocityStatistics, CallAFoldedVelocityWrongByTheWholeSpan) {
  Velocity velocity;
  velocity.Add(Record(RecedingWall({.sigma_mps = 0.0, .max_mps = 6.0})));
  EXPECT_NEAR(SumAt(velocity, 26.0).errors_mps.plain.PlainMean(), -12.0, kRounding_mps);
  EXPECT_TRUE(velocity.distribution().contains(-2)) << "9 m/s less 12 m/s";
}

TEST(VelocityStatistics, CountPointsWithoutAVelocity) {
  Frame frame = RecedingWall(kExact);
  for (std::size_t slot = 0; slot < frame.num_slots(); slot += 4) {
    frame.radial_velocity_mps[slot] = NAN;
  }
  Velocity velocity;
  velocity.Add(Record(frame));
  const Section section = velocity.MakeSection();
  ASSERT_EQ(section.tables[0].rows.size(), 1U);
  EXPECT_EQ(std::get<Estimate>(section.tables[0].rows[0][2]).value, 75.0);
}

TEST(VelocityStatistics, AreSummedUpOfParts) {
  Velocity whole, first, second;
  const RecordedFrame a = Record(RecedingWall(kExact, 0));
  const RecordedFrame b = Record(RecedingWall(kExact, 1));
  whole.Add(a);
  whole.Add(b);
  first.Add(a);
  second.Add(b);
  AddTo(first, second);
  EXPECT_EQ(first.distribution(), whole.distribution());
  EXPECT_EQ(SumAt(first, 26.0).num_points, SumAt(whole, 26.0).num_points);
  EXPECT_NEAR(SumAt(first, 26.0).measured_mps.PlainMean(),
              SumAt(whole, 26.0).measured_mps.PlainMean(), 1e-9);
}

TEST(VelocityStatistics, AreLeftOutWhereNothingMeasuresThem) {
  Velocity velocity;
  velocity.Add(Record(ScanOnce(WorldWithWallAt(25.0), MakeRaster(20.0, 10.0, 1.0))));
  EXPECT_TRUE(velocity.is_empty());
}

TEST(VelocityStatistics, HaveNoErrorsWithoutTheTruth) {
  RecordedFrame recorded = Record(RecedingWall(kExact));
  recorded.fields.erase("true_radial_velocity_mps");
  Velocity velocity;
  velocity.Add(recorded);
  EXPECT_FALSE(velocity.has_truth());
  const Section section = velocity.MakeSection();
  EXPECT_EQ(section.tables[0].columns.size(), 4U);
  EXPECT_EQ(section.charts.size(), 1U);
}

TEST(StatisticsReport, HasTheNoiseOfVelocitiesAtItsHeadWhereSensorsMeasureThem) {
  const auto titles_of = [](const Frame& frame) {
    Statistics statistics;
    statistics.Add(Record(frame), nullptr);
    std::string titles;
    for (const Headline& line : MakeStatisticsReport(statistics, {{}}, "").headlines) {
      titles += line.title + ";";
    }
    return titles;
  };
  EXPECT_NE(titles_of(RecedingWall(kExact)).find("Noise of velocity, 20 to 30 m;"),
            std::string::npos);
  EXPECT_EQ(titles_of(ScanOnce(WorldWithWallAt(25.0), MakeRaster(20.0, 10.0, 1.0)))
                .find("Noise of velocity"),
            std::string::npos);
}

}  // namespace
}  // namespace railcast
