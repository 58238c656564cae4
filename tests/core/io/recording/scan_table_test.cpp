#include "core/io/recording/scan_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <string>

#include "core/io/recording/sensor_axes.h"
#include "tests/support/analytic_meshes.h"
#include "tests/support/scan_once.h"
#include "tests/support/sensor_file.h"
#include "tests/support/simple_world.h"

namespace railcast {
namespace {

class ScanTableOf : public testing::TestWithParam<std::string> {};

// Inside a sphere every firing has a point, so the table made from points must be that of the
// pattern.
TEST_P(ScanTableOf, PointsIsThatOfThePattern) {
  const ScanPattern pattern = BuildScanPattern(ReadSensor(GetParam()));
  auto world = std::make_shared<SimpleWorld>();
  world->ground.parts = {{MakeSphere(20.0, 24, 48), 2, 1}};
  const auto from_points = MakeScanTable(ScanOnce(world, pattern));
  const auto from_pattern = MakeScanTable(pattern);
  ASSERT_TRUE(from_points && from_pattern);
  for (std::size_t i = 0; i < pattern.num_firings(); ++i) {
    const Vector3 direction = DirectionOf(pattern, i);
    for (const auto& table : {from_points, from_pattern}) {
      const auto found = table->Direction(pattern.row[i], pattern.column[i]);
      ASSERT_NEAR((Vector3(found[0], found[1], found[2]) - direction).norm(), 0.0, 2e-6);
    }
  }
  EXPECT_NEAR(from_points->column_step_rad, from_pattern->column_step_rad, 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Sensors,
                         ScanTableOf,
                         testing::Values("vlp16", "vlp32c", "pandar64", "hdl32e"));

TEST(ScanTable, OfASensorThatLiesOnItsSideIsInTheAxesOfItsPoints) {
  const ScanPattern pattern = BuildScanPattern(ReadSensor("vlp16"));
  auto world = std::make_shared<SimpleWorld>();
  world->ground.parts = {{MakeSphere(20.0, 24, 48), 2, 1}};
  const Frame upright = ScanOnce(world, pattern);
  Frame frame = upright;
  frame.sensor_from_spin = RotationFromYawPitchRoll(0.7, 1.2, 0.0);
  for (std::size_t i = 0; i < frame.num_slots(); ++i) {
    const Eigen::Vector3f turned_m =
        frame.sensor_from_spin->cast<float>() * Eigen::Vector3f(frame.x[i], frame.y[i], frame.z[i]);
    frame.x[i] = turned_m.x();
    frame.y[i] = turned_m.y();
    frame.z[i] = turned_m.z();
  }
  const auto table = MakeScanTable(frame);
  ASSERT_TRUE(table);
  for (std::size_t i = 0; i < pattern.num_firings(); ++i) {
    const Vector3 direction = *frame.sensor_from_spin * DirectionOf(pattern, i);
    const auto found = table->Direction(pattern.row[i], pattern.column[i]);
    ASSERT_NEAR((Vector3(found[0], found[1], found[2]) - direction).norm(), 0.0, 2e-6);
  }
  TurnToSpinAxes(frame);
  EXPECT_FALSE(frame.sensor_from_spin.has_value());
  for (std::size_t i = 0; i < frame.num_slots(); ++i) {
    ASSERT_NEAR(frame.x[i], upright.x[i], 1e-5);
    ASSERT_NEAR(frame.z[i], upright.z[i], 1e-5);
  }
}

TEST(ScanTable, OfARasterHasItsSolidAngles) {
  const auto table = MakeScanTable(MakeRaster(60.0, 30.0, 0.25));
  ASSERT_TRUE(table);
  double sum_sr = 0.0;
  for (std::size_t row = 0; row < table->rows; ++row) {
    sum_sr += table->SolidAngle_sr(row) * table->columns;
  }
  // The solid angle of the whole field of view is azimuth x (sin top - sin bottom).
  const double expected_sr = std::numbers::pi / 3.0 * 2.0 * std::sin(std::numbers::pi / 12.0);
  EXPECT_NEAR(sum_sr / expected_sr, 1.0, 1e-4);
}

TEST(ScanTable, FillsGapsBetweenWhatIsKnown) {
  auto world = std::make_shared<SimpleWorld>();
  world->ground.parts = {{MakeWall(20.0F, 40.0F), 2, 1}};
  const ScanPattern pattern = MakeRaster(60.0, 30.0, 0.25);
  Frame frame = ScanOnce(world, pattern);
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    const std::size_t row = slot / frame.width();
    const std::size_t column = slot % frame.width();
    if ((row > 40 && row < 60) || (column > 100 && column < 140)) {
      frame.range_m[slot] = std::nanf("");
    }
  }
  const auto table = MakeScanTable(frame);
  const auto truth = MakeScanTable(pattern);
  ASSERT_TRUE(table);
  EXPECT_NEAR(table->elevation_rad[50], truth->elevation_rad[50], 1e-6);
  EXPECT_NEAR(table->column_azimuth_rad[120], truth->column_azimuth_rad[120], 1e-6);
}

// As of a sensor in a room, whose upper rows meet the ceiling where the lower ones meet nothing.
TEST(ScanTable, SettlesOffsetsOfRowsThatSeeOtherColumns) {
  constexpr std::uint32_t kRows = 8;
  constexpr std::uint32_t kColumns = 64;
  const auto offset_rad = [](std::uint32_t row) { return row < kRows / 2 ? 0.0 : 0.003; };
  Frame frame;
  frame.Resize(kRows, kColumns, 1);
  for (std::uint32_t row = 0; row < kRows; ++row) {
    for (std::uint32_t column = 0; column < kColumns; ++column) {
      const std::size_t slot = row * kColumns + column;
      frame.range_m[slot] = column >= 4 * row && column < 4 * row + 32 ? 10.0F : std::nanf("");
      const double azimuth_rad = -0.01 * column + offset_rad(row);
      frame.x[slot] = static_cast<float>(10.0 * std::cos(azimuth_rad));
      frame.y[slot] = static_cast<float>(10.0 * std::sin(azimuth_rad));
      frame.z[slot] = 0.2F * static_cast<float>(row);
    }
  }
  const std::vector<double> aside_rad(kRows, 0.0);
  const auto table = MakeScanTable(frame, {}, aside_rad);
  ASSERT_TRUE(table);
  for (std::uint32_t row = 0; row < kRows; ++row) {
    EXPECT_NEAR(table->row_azimuth_rad[row] - table->row_azimuth_rad[0], offset_rad(row), 1e-6)
        << "float32 at 10 m is known to 5e-7 m";
  }
}

TEST(ScanTable, KnowsWhoLooksIntoTheSameDirection) {
  // The rows of a Pandar64 differ in azimuth by up to 5.2 deg to either side.
  const ScanPattern pattern = BuildScanPattern(ReadSensor("pandar64"));
  const auto table = MakeScanTable(pattern);
  ASSERT_TRUE(table);
  EXPECT_TRUE(table->is_full_turn);
  for (std::size_t row = 1; row < table->rows; ++row) {
    for (const std::size_t column : {0U, 17U, 900U, 1790U, 1799U}) {
      const auto beside = table->ColumnBeside(row, column, row - 1);
      ASSERT_TRUE(beside);
      const auto here = table->Direction(row, column);
      const auto there = table->Direction(row - 1, *beside);
      const double between_rad = std::atan2(here[1], here[0]) - std::atan2(there[1], there[0]);
      ASSERT_LT(std::abs(std::remainder(between_rad, 2.0 * std::numbers::pi)),
                1.01 * table->column_step_rad);
    }
  }
  const auto raster = MakeScanTable(MakeRaster(60.0, 30.0, 0.25));
  EXPECT_FALSE(raster->is_full_turn);
  EXPECT_EQ(raster->ColumnBeside(5, 0, 6), 0U);
}

// Its lasers lie beside each other, but each draws loops over the whole view.
TEST(ScanTable, OfAFigureOfLoopsIsNone) {
  const ScanPattern pattern = BuildScanPattern(ReadSensor("tele15_like"));
  ASSERT_EQ(pattern.rows, 6U);
  EXPECT_FALSE(MakeScanTable(pattern));
  auto world = std::make_shared<SimpleWorld>();
  world->ground.parts = {{MakeSphere(20.0, 24, 48), 2, 1}};
  EXPECT_FALSE(MakeScanTable(ScanOnce(world, pattern)));
}

TEST(ScanTable, OfAListOfFiringsIsNone) {
  Frame frame;
  frame.Resize(1, 100, 1);
  EXPECT_FALSE(MakeScanTable(frame));
}

}  // namespace
}  // namespace railcast
