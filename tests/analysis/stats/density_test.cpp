#include "analysis/stats/statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <variant>
#include <vector>

#include "analysis/stats/bins.h"
#include "tests/analysis/recorded_frames.h"
#include "tests/support/analytic_meshes.h"
#include "tests/support/scan_once.h"
#include "tests/support/simple_world.h"

namespace railcast {
namespace {

constexpr double kStep_rad = 0.25 * std::numbers::pi / 180.0;

ScanPattern Raster() {
  return MakeRaster(60.0, 30.0, 0.25);
}

Frame ScanFloor(float height_m = 2.5F) {
  auto world = std::make_shared<SimpleWorld>();
  world->ground.parts = {{MakeFloor(-height_m, 300.0F), 2, 5}};
  return ScanOnce(world, Raster());
}

// A wall that faces the sensor, small enough to be met at nearly constant incidence.
Frame ScanWall(float x_m) {
  auto world = std::make_shared<SimpleWorld>();
  world->ground.parts = {{MakeWall(x_m, 0.1F * x_m), 2, 6}};
  return ScanOnce(world, Raster());
}

constexpr float kDistances_m[] = {10, 14, 20, 28, 40, 57, 80, 113, 160};

TEST(Density, FallsWithTheThirdPowerOfRangeOnGround) {
  Density density;
  const auto scan = MakeScanTable(Raster());
  density.Add(Record(ScanFloor()), &*scan);
  const PowerLaw law = Density::LawOf(density.by_label().at(5));
  EXPECT_NEAR(law.exponent.value, -3.0, 0.1);
  EXPECT_LE(law.exponent.low, -3.0);
  EXPECT_GE(law.exponent.high, -3.0);
  // n(R) = h / (W R^3), where W is the solid angle of a beam near the horizon.
  EXPECT_NEAR(law.factor / (2.5 / (kStep_rad * kStep_rad)), 1.0, 0.05);
}

TEST(Density, FallsWithTheSquareOfRangeOnFacesMetAlike) {
  Density density;
  const auto scan = MakeScanTable(Raster());
  for (const float x_m : kDistances_m) density.Add(Record(ScanWall(x_m)), &*scan);
  const PowerLaw law = Density::LawOf(density.by_label().at(6));
  EXPECT_NEAR(law.exponent.value, -2.0, 0.1);
  EXPECT_NEAR(law.factor * kStep_rad * kStep_rad, 1.0, 0.05);
}

TEST(StatisticsReport, GivesTheDensityOfTheSurfaceWithTheMostPoints) {
  Statistics statistics;
  const auto scan = MakeScanTable(Raster());
  statistics.Add(Record(ScanFloor()), &*scan);
  for (const float x_m : {10.0F, 20.0F, 40.0F}) statistics.Add(Record(ScanWall(x_m)), &*scan);
  std::vector<double> exponents;
  for (const Headline& line : MakeStatisticsReport(statistics, {{}}, "").headlines) {
    if (!line.title.starts_with("Exponent of density")) continue;
    exponents.push_back(std::get<Estimate>(line.value).value);
  }
  ASSERT_FALSE(exponents.empty());
  EXPECT_NEAR(exponents.front(), -3.0, 0.1);
}

TEST(Density, HasTheSameLawsFromPointsAlone) {
  Density density;
  const RecordedFrame ground = RecordPointsOnly(ScanFloor());
  const auto ground_scan = MakeScanTable(ground.frame);
  density.Add(ground, &*ground_scan);
  for (const float x_m : kDistances_m) {
    const RecordedFrame wall = RecordPointsOnly(ScanWall(x_m));
    const auto scan = MakeScanTable(wall.frame);
    density.Add(wall, &*scan);
  }
  EXPECT_NEAR(Density::LawOf(density.by_attitude().at("level")).exponent.value, -3.0, 0.1);
  EXPECT_NEAR(Density::LawOf(density.by_attitude().at("upright")).exponent.value, -2.0, 0.1);
  EXPECT_EQ(density.by_attitude().count("slanted"), 0U);
}

TEST(Density, CountsLostPointsAsAreaWithoutPoints) {
  SimulatorSpec spec{.detector = {.effects = {.sensor_dropout = true}}};
  spec.detector.plausibility.dropout_probability = 0.3;
  auto world = std::make_shared<SimpleWorld>();
  world->ground.parts = {{MakeWall(20.0F, 40.0F), 2, 6}};
  const auto scan = MakeScanTable(Raster());
  Density all, thinned;
  all.Add(Record(ScanOnce(world, Raster())), &*scan);
  thinned.Add(Record(ScanOnce(world, Raster(), spec)), &*scan);
  const auto bin = FineRangeBins().Find(21.0).value();
  const Density::Count& before = all.by_label().at(6)[bin];
  const Density::Count& after = thinned.by_label().at(6)[bin];
  EXPECT_EQ(after.area_m2, before.area_m2);
  const auto n = static_cast<double>(before.num_points);
  EXPECT_NEAR(static_cast<double>(after.num_points), 0.7 * n, 4.0 * std::sqrt(0.21 * n));
}

TEST(Density, FromPointsAloneSeesLossesToo) {
  SimulatorSpec spec{.detector = {.effects = {.sensor_dropout = true}}};
  spec.detector.plausibility.dropout_probability = 0.4;
  auto world = std::make_shared<SimpleWorld>();
  world->ground.parts = {{MakeWall(20.0F, 40.0F), 2, 6}};
  const auto scan = MakeScanTable(Raster());
  Density all, thinned;
  all.Add(RecordPointsOnly(ScanOnce(world, Raster())), &*scan);
  thinned.Add(RecordPointsOnly(ScanOnce(world, Raster(), spec)), &*scan);
  const auto bin = FineRangeBins().Find(21.0).value();
  const auto density_per_m2 = [bin](const Density& density) {
    const Density::Count& count = density.by_attitude().at("upright")[bin];
    return static_cast<double>(count.num_points) / count.area_m2;
  };
  // 13 % of the firings have all four neighbours: more than 1000 firings here.
  const Density::Count& count = thinned.by_attitude().at("upright")[bin];
  ASSERT_GT(count.num_firings, 1000U);
  EXPECT_NEAR(density_per_m2(thinned) / density_per_m2(all), 0.6, 0.06);
}

TEST(Density, OfAFrameWithoutPointsIsEmpty) {
  Frame frame = ScanFloor();
  for (auto* field : {&frame.x, &frame.y, &frame.z, &frame.range_m}) {
    std::fill(field->begin(), field->end(), std::nanf(""));
  }
  EXPECT_FALSE(MakeScanTable(frame));
  Density density;
  density.Add(RecordPointsOnly(frame), nullptr);
  EXPECT_TRUE(density.is_empty());
  EXPECT_FALSE(Density::LawOf({}).exponent.is_enough());
}

}  // namespace
}  // namespace railcast
