#include "analysis/stats/range_noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "analysis/stats/bins.h"
#include "analysis/stats/neighbour_noise.h"
#include "analysis/stats/statistics.h"
#include "core/base/random.h"
#include "tests/analysis/recorded_frames.h"
#include "tests/support/analytic_meshes.h"
#include "tests/support/scan_once.h"
#include "tests/support/simple_world.h"

namespace railcast {
namespace {

constexpr int kNumNoiseFrames = 20;

ScanPattern NoiseRaster() {
  return MakeRaster(60.0, 30.0, 0.25);
}

/// A wall at `x_m` that fills the field of view, scanned with noise of `sigma_m` at any range.
class NoisyWall {
 public:
  NoisyWall(float x_m, double sigma_m, NoiseShape shape)
      : simulator_(MakeWorld(x_m), NoiseRaster(), TestMaterials(), SpecOf(sigma_m, shape), 0) {}

  Frame Scan(std::uint32_t index) {
    Frame frame;
    simulator_.Scan(index, frame);
    return frame;
  }

 private:
  static std::shared_ptr<SimpleWorld> MakeWorld(float x_m) {
    auto world = std::make_shared<SimpleWorld>();
    world->ground.parts = {{MakeWall(x_m, 2.0F * x_m), 2, 1}};
    return world;
  }
  static SimulatorSpec SpecOf(double sigma_m, NoiseShape shape) {
    SimulatorSpec spec{.detector = {.effects = {.threshold = true, .noise = true}}};
    spec.detector.plausibility.noise_sigma0_m = sigma_m;
    spec.detector.plausibility.noise_sigma1 = 0.0;
    spec.detector.plausibility.noise_shape = shape;
    return spec;
  }

  Simulator simulator_;
};

Noise MeasureNoise(NoisyWall& wall, double outlier_share = 0.0) {
  Noise noise;
  const auto scan = MakeScanTable(NoiseRaster());
  for (std::uint32_t index = 0; index < kNumNoiseFrames; ++index) {
    Frame frame = wall.Scan(index);
    for (std::uint32_t slot = 0; slot < frame.num_slots(); ++slot) {
      const auto words = RandomWords(9, RandomUse::kNoise, index, slot);
      if (static_cast<double>(UnitFloat(words[0])) >= outlier_share) continue;
      const float scale = 0.5F + UnitFloat(words[1]);
      for (auto* field : {&frame.x, &frame.y, &frame.z, &frame.range_m}) (*field)[slot] *= scale;
    }
    const RecordedFrame recorded = Record(std::move(frame));
    noise.Add(recorded, FindPlanePatches(recorded, &*scan));
  }
  return noise;
}

const Noise::Planes& PlanesAt(const Noise& noise, double range_m) {
  return noise.planes()[RangeBins().Find(range_m).value()];
}

class RangeNoise : public testing::TestWithParam<double> {};

TEST_P(RangeNoise, AlongTheBeamsIsRecoveredWithinFivePercent) {
  const double sigma_m = GetParam();
  NoisyWall wall(25.0F, sigma_m, NoiseShape::kBeam);
  const Noise::Planes bin = PlanesAt(MeasureNoise(wall), 25.0);
  ASSERT_GT(bin.range_sigmas_m.num(), 500U);
  EXPECT_NEAR(bin.RangeSigma_m().value / sigma_m, 1.0, 0.05);
  EXPECT_NEAR(bin.RobustRangeSigma_m().value / sigma_m, 1.0, 0.05);
}

TEST_P(RangeNoise, AlikeInAllDirectionsIsThatSquareToThePlane) {
  const double sigma_m = GetParam();
  NoisyWall wall(25.0F, sigma_m, NoiseShape::kIsotropic);
  const Noise::Planes bin = PlanesAt(MeasureNoise(wall), 25.0);
  EXPECT_NEAR(bin.PlaneSigma_m().value / sigma_m, 1.0, 0.05);
  EXPECT_NEAR(bin.RobustPlaneSigma_m().value / sigma_m, 1.0, 0.05);
}

TEST_P(RangeNoise, IsWhatPclEstimates) {
  NoisyWall wall(25.0F, GetParam(), NoiseShape::kIsotropic);
  const Noise::Planes bin = PlanesAt(MeasureNoise(wall), 25.0);
  ASSERT_GT(bin.pcl_sigmas_m.num(), 500U);
  // PCL's median of 25 squares has a standard error of 24 %, that of the median over 500 patches is
  // a twentieth of it, and four of them are 5 %.
  EXPECT_NEAR(bin.pcl_sigmas_m.Median().value / bin.RobustPlaneSigma_m().value, 1.0, 0.05);
  // Both planes go through almost the same points.
  EXPECT_LT(bin.pcl_turns_rad.Median().value, 0.1 * bin.pcl_normals_rad.Median().value);
}

TEST_P(RangeNoise, IsExactFromTheTruth) {
  const double sigma_m = GetParam();
  NoisyWall wall(25.0F, sigma_m, NoiseShape::kBeam);
  const Noise noise = MeasureNoise(wall);
  const Scatter& bin = noise.truth()[RangeBins().Find(25.0).value()];
  // The tolerance is four standard errors for 300,000 samples or more.
  EXPECT_NEAR(bin.plain.StandardDeviation().value / sigma_m, 1.0, 0.006);
  EXPECT_NEAR(bin.robust.RobustScale().value / sigma_m, 1.0, 0.015);
  EXPECT_NEAR(bin.plain.Mean().value / sigma_m, 0.0, 0.01);
}

INSTANTIATE_TEST_SUITE_P(FromMillimetresToDecimetres,
                         RangeNoise,
                         testing::Values(0.002, 0.015, 0.06));

TEST(Noise, StandsOnePointInTwentyGoneWild) {
  NoisyWall wall(25.0F, 0.015, NoiseShape::kBeam);
  const Noise::Planes bin = PlanesAt(MeasureNoise(wall, 0.05), 25.0);
  ASSERT_GT(bin.range_sigmas_m.num(), 100U);
  EXPECT_NEAR(bin.RobustRangeSigma_m().value / 0.015, 1.0, 0.05);
  EXPECT_GT(bin.num_outliers, 0U);
  EXPECT_NEAR(static_cast<double>(bin.num_pcl_outliers) / static_cast<double>(bin.num_outliers),
              1.0, 0.05);
}

TEST(Noise, WithoutAGridComesFromNeighboursInSpace) {
  NoisyWall wall(25.0F, 0.015, NoiseShape::kBeam);
  Noise noise;
  for (std::uint32_t index = 0; index < 3; ++index) {
    RecordedFrame recorded = RecordPointsOnly(wall.Scan(index));
    recorded.is_grid = false;
    noise.Add(recorded, FindPlanePatches(recorded, nullptr));
  }
  EXPECT_NEAR(PlanesAt(noise, 25.0).RobustRangeSigma_m().value / 0.015, 1.0, 0.1);
  EXPECT_TRUE(noise.truth().empty());
}

TEST(Noise, OfTooFewPointsIsNoNumber) {
  NoisyWall wall(25.0F, 0.015, NoiseShape::kBeam);
  const auto scan = MakeScanTable(NoiseRaster());
  for (const std::size_t num_points : {0U, 1U, 2U, 11U}) {
    Frame frame = wall.Scan(0);
    for (std::size_t slot = num_points; slot < frame.num_slots(); ++slot) {
      frame.range_m[slot] = frame.x[slot] = frame.y[slot] = frame.z[slot] = std::nanf("");
    }
    for (const bool is_grid : {true, false}) {
      RecordedFrame recorded = RecordPointsOnly(frame);
      recorded.is_grid = is_grid;
      EXPECT_TRUE(FindPlanePatches(recorded, is_grid ? &*scan : nullptr).empty());
    }
  }
  Noise noise;
  noise.Add(RecordPointsOnly(wall.Scan(0)), {});
  EXPECT_FALSE(PlanesAt(noise, 25.0).RangeSigma_m().is_enough());
  EXPECT_FALSE(PlanesAt(noise, 25.0).RobustRangeSigma_m().is_enough());
}

Estimate NeighbourSigma_m(const std::vector<RecordedFrame>& frames) {
  NeighbourNoise noise;
  for (const RecordedFrame& frame : frames) noise.Add(frame);
  return noise.Sigma_m(RangeBins().Find(25.0).value());
}

TEST_P(RangeNoise, OfNeighboursIsRecoveredWithoutAPlane) {
  const double sigma_m = GetParam();
  NoisyWall wall(25.0F, sigma_m, NoiseShape::kBeam);
  std::vector<RecordedFrame> frames = {RecordPointsOnly(wall.Scan(0))};
  const Estimate plain = NeighbourSigma_m(frames);
  ASSERT_GT(plain.num, 5'000U);
  // The interval is 1.96 standard errors wide on each side; four of them hold the truth.
  EXPECT_NEAR(plain.value, sigma_m, 2.0 * (plain.high - plain.low) / 2.0);
  // A corrugation of 20 columns, 30 mm high, is no plane, but bends by 3 mm in three firings:
  // 30 mm x (2 pi / 20)^2 / sqrt(6) at its crests.
  Frame& frame = frames.front().frame;
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    const double column = static_cast<double>(slot % frame.width() / frame.returns);
    frame.range_m[slot] += static_cast<float>(0.03 * std::sin(column * std::numbers::pi / 10.0));
  }
  EXPECT_GT(NeighbourSigma_m(frames).value, 0.95 * sigma_m);
  EXPECT_LT(NeighbourSigma_m(frames).value, 1.05 * std::hypot(sigma_m, 0.0013));
}

TEST(NeighbourNoise, UnderstatesWhereNeighboursAreAveraged) {
  NoisyWall wall(25.0F, 0.015, NoiseShape::kBeam);
  const auto scan = MakeScanTable(NoiseRaster());
  std::vector<RecordedFrame> frames;
  for (std::uint32_t index = 0; index < 2; ++index) {
    RecordedFrame& recorded = frames.emplace_back(RecordPointsOnly(wall.Scan(index)));
    std::vector<float>& range_m = recorded.frame.range_m;
    for (std::size_t slot = 0; slot + 1 < range_m.size(); ++slot) {
      range_m[slot] = 0.5F * (range_m[slot] + range_m[slot + 1]);
    }
  }
  TemporalNoise temporal;
  temporal.Add(frames[0], frames[1], &*scan, &*scan);
  const std::size_t bin = RangeBins().Find(25.0).value();
  const double left_m = 0.015 / std::numbers::sqrt2;
  EXPECT_NEAR(temporal.bins()[bin].RobustSigma_m().value / left_m, 1.0, 0.05);
  EXPECT_NEAR(NeighbourSigma_m(frames).value / left_m, 1.0 / std::sqrt(3.0), 0.03);
}

TEST(NeighbourNoise, TakesNoPartAtEdgesNorOfPointsWithoutFirings) {
  NoisyWall wall(25.0F, 0.015, NoiseShape::kBeam);
  RecordedFrame recorded = RecordPointsOnly(wall.Scan(0));
  // A step of 2 m every ten columns.
  for (std::size_t slot = 0; slot < recorded.frame.num_slots(); ++slot) {
    recorded.frame.range_m[slot] += 2.0F * static_cast<float>(slot / 10 % 2);
  }
  NeighbourNoise noise;
  noise.Add(recorded);
  for (const Scatter& bin : noise.bins()) {
    if (bin.num() == 0) continue;
    EXPECT_LT(bin.plain.StandardDeviation().value, 0.016);
  }
  recorded.is_grid = false;
  NeighbourNoise none;
  none.Add(recorded);
  EXPECT_TRUE(none.bins().empty());
}

TEST(TemporalNoise, IsRecoveredWithinFivePercent) {
  NoisyWall wall(25.0F, 0.015, NoiseShape::kBeam);
  const auto scan = MakeScanTable(NoiseRaster());
  TemporalNoise noise;
  for (std::uint32_t index = 0; index < 10; index += 2) {
    noise.Add(Record(wall.Scan(index)), Record(wall.Scan(index + 1)), &*scan, &*scan);
  }
  const TemporalNoise::Bin& bin = noise.bins()[RangeBins().Find(25.0).value()];
  EXPECT_NEAR(bin.Sigma_m().value / 0.015, 1.0, 0.05);
  EXPECT_NEAR(bin.RobustSigma_m().value / 0.015, 1.0, 0.05);
  EXPECT_EQ(noise.num_pairs(), 5U);
}

// The turns of a capture begin at any azimuth: here the second frame is offset by 0.4 columns from
// the first, on a wall so slanted that this alone changes the range by 40 mm.
TEST(TemporalNoise, CorrectsForColumnsBesideEachOther) {
  NoisyWall wall(25.0F, 0.015, NoiseShape::kBeam);
  const auto scan = MakeScanTable(NoiseRaster());
  auto slanted = std::make_shared<SimpleWorld>();
  slanted->ground.parts = {
      {{{{20, 20, -20}, {40, -20, -20}, {40, -20, 20}, {20, 20, 20}}, {{0, 1, 2}, {0, 2, 3}}},
       2,
       1}};
  SimulatorSpec spec{.detector = {.effects = {.threshold = true, .noise = true}}};
  spec.detector.plausibility.noise_sigma0_m = 0.015;
  spec.detector.plausibility.noise_sigma1 = 0.0;
  spec.detector.plausibility.noise_shape = NoiseShape::kBeam;
  const Frame first = ScanOnce(slanted, MakeRaster(40.0, 20.0, 0.25), spec, 0);
  // Turn the sensor by 0.1 deg and its points back, which has the effect of offset columns.
  const Eigen::AngleAxisd turn(0.1 * 3.141592653589793 / 180.0, Vector3::UnitZ());
  spec.vehicle_from_sensor = Transform::Identity();
  spec.vehicle_from_sensor.rotate(turn);
  Frame second = ScanOnce(slanted, MakeRaster(40.0, 20.0, 0.25), spec, 1);
  for (std::size_t slot = 0; slot < second.num_slots(); ++slot) {
    const Vector3 turned =
        turn * Vector3(static_cast<double>(second.x[slot]), static_cast<double>(second.y[slot]),
                       static_cast<double>(second.z[slot]));
    second.x[slot] = static_cast<float>(turned.x());
    second.y[slot] = static_cast<float>(turned.y());
  }
  TemporalNoise noise;
  const auto first_scan = MakeScanTable(first);
  const auto second_scan = MakeScanTable(second);
  noise.Add(RecordPointsOnly(first), RecordPointsOnly(second), &*first_scan, &*second_scan);
  ASSERT_EQ(noise.num_pairs(), 1U);
  const TemporalNoise::Bin& bin = noise.bins()[RangeBins().Find(28.0).value()];
  ASSERT_GT(bin.differences_m.num(), 1000U);
  EXPECT_NEAR(bin.Sigma_m().value / 0.015, 1.0, 0.07);
  EXPECT_NEAR(bin.differences_m.plain.Mean().value, 0.0, 0.002);
}

/// Rounds the ranges of a frame, and moves its points along their beams.
Frame InSteps(Frame frame, double step_m) {
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    const float before_m = frame.range_m[slot];
    if (!std::isfinite(before_m)) continue;
    const double steps = std::round(static_cast<double>(before_m) / step_m);
    frame.range_m[slot] = static_cast<float>(step_m * steps);
    const float scale = frame.range_m[slot] / before_m;
    for (auto* field : {&frame.x, &frame.y, &frame.z}) (*field)[slot] *= scale;
  }
  return frame;
}

TEST(Noise, OfPlanesAndTurnsIsThatBeforeRounding) {
  constexpr double kSigma_m = 0.002;
  NoisyWall wall(25.0F, kSigma_m, NoiseShape::kBeam);
  const auto scan = MakeScanTable(NoiseRaster());
  for (const double steps : {0.03, 0.1, 0.3, 0.5, 0.7, 1.0, 2.0, 5.0}) {
    SCOPED_TRACE(steps);
    TemporalNoise temporal;
    Noise planes;
    for (std::uint32_t index = 0; index < 6; index += 2) {
      const RecordedFrame first = Record(InSteps(wall.Scan(index), steps * kSigma_m));
      const RecordedFrame second = Record(InSteps(wall.Scan(index + 1), steps * kSigma_m));
      temporal.Add(first, second, &*scan, &*scan);
      planes.Add(first, FindPlanePatches(first, &*scan));
    }
    const std::size_t bin = RangeBins().Find(25.0).value();
    for (const Estimate& sigma_m :
         {temporal.bins()[bin].RobustSigma_m(), planes.planes()[bin].RobustRangeSigma_m()}) {
      EXPECT_NEAR(sigma_m.value / kSigma_m, 1.0, 0.1);
      EXPECT_LT(sigma_m.low / kSigma_m, 1.02);
      EXPECT_GT(sigma_m.high / kSigma_m, 0.98);
    }
  }
}

TEST(TemporalNoise, IsNotWhatAllBeamsShare) {
  NoisyWall wall(25.0F, 0.015, NoiseShape::kBeam);
  const auto scan = MakeScanTable(NoiseRaster());
  Frame second = wall.Scan(1);
  for (float& range_m : second.range_m) range_m += 0.1F;
  TemporalNoise noise;
  noise.Add(Record(wall.Scan(0)), Record(second), &*scan, &*scan);
  const TemporalNoise::Bin& bin = noise.bins()[RangeBins().Find(25.0).value()];
  // Plain and robust estimate agree, since both are taken about the middle.
  EXPECT_NEAR(bin.Sigma_m().value / 0.015, 1.0, 0.05);
  EXPECT_NEAR(bin.RobustSigma_m().value / 0.015, 1.0, 0.08);
}

TEST(TemporalNoise, TakesNoPartOfFramesBetweenWhichTheSensorMoved) {
  NoisyWall wall(25.0F, 0.015, NoiseShape::kBeam);
  const auto scan = MakeScanTable(NoiseRaster());
  Frame second = wall.Scan(1);
  second.world_from_sensor.translate(Vector3(0.01, 0, 0));
  TemporalNoise noise;
  noise.Add(Record(wall.Scan(0)), Record(second), &*scan, &*scan);
  EXPECT_EQ(noise.num_pairs(), 0U);
  EXPECT_EQ(noise.num_moved(), 1U);
  EXPECT_TRUE(noise.bins().empty());
}

TEST(Intensity, OfAFlatPieceIsThatOfThePointsThatHaveOne) {
  NoisyWall wall(25.0F, 0.002, NoiseShape::kBeam);
  RecordedFrame points = RecordPointsOnly(wall.Scan(0));
  for (std::size_t slot = 0; slot < points.frame.num_slots(); slot += 5) {
    points.frame.intensity[slot] = std::nanf("");
  }
  const auto scan = MakeScanTable(NoiseRaster());
  for (const PlanePatch& patch : FindPlanePatches(points, &*scan)) {
    EXPECT_NEAR(patch.intensity, 0.5 * std::cos(patch.incidence_rad), 0.01);
  }
}

TEST(Intensity, OfALambertianFallsWithTheCosine) {
  NoisyWall wall(25.0F, 0.002, NoiseShape::kBeam);
  const RecordedFrame recorded = Record(wall.Scan(0));
  const auto scan = MakeScanTable(NoiseRaster());
  Intensity exact, from_planes;
  exact.Add(recorded, {});
  const RecordedFrame points = RecordPointsOnly(recorded.frame);
  from_planes.Add(points, FindPlanePatches(points, &*scan));
  const std::size_t bin = IncidenceBins().Find(25.0).value();
  // The reflectivity is 0.5; the bin's mean lies between the values at its ends.
  for (const Intensity* intensity : {&exact, &from_planes}) {
    const Estimate mean = intensity->groups().Of(GroupBy::kIncidence).at(bin).plain.Mean();
    EXPECT_GT(mean.value, 0.5 * std::cos(30.0 * 3.14159265 / 180.0));
    EXPECT_LT(mean.value, 0.5 * std::cos(20.0 * 3.14159265 / 180.0));
  }
}

}  // namespace
}  // namespace railcast
