#include "core/rail/landform/landform.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>

#include "tests/core/io/message_of.h"

namespace railcast {
namespace {

constexpr double kCell_m = 30.0;

/// A grid of 40 x 30 cells about heights at their middles; its lower left corner is (1000, 2000).
std::string GridOf(const std::function<double(double x_m, double y_m)>& height_m) {
  std::ostringstream text;
  text.precision(17);
  text << "ncols 40\nnrows 30\nxllcorner 1000\nyllcorner 2000\ncellsize 30\nNODATA_value -9999\n";
  for (int row = 29; row >= 0; --row) {
    for (int column = 0; column < 40; ++column) {
      text << height_m(1000.0 + kCell_m * (column + 0.5), 2000.0 + kCell_m * (row + 0.5)) << ' ';
    }
    text << '\n';
  }
  return text.str();
}

double Bilinear(const std::function<double(double, double)>& height_m, double x_m, double y_m) {
  const double u = (x_m - 1000.0) / kCell_m - 0.5;
  const double v = (y_m - 2000.0) / kCell_m - 0.5;
  const auto node_m = [&](double i, double j) {
    return height_m(1000.0 + kCell_m * (i + 0.5), 2000.0 + kCell_m * (j + 0.5));
  };
  const double i = std::floor(u);
  const double j = std::floor(v);
  return std::lerp(std::lerp(node_m(i, j), node_m(i + 1, j), u - i),
                   std::lerp(node_m(i, j + 1), node_m(i + 1, j + 1), u - i), v - j);
}

double WavyHeight_m(double x_m, double y_m) {
  constexpr double kWave_per_m = 2.0 * 3.14159265358979 / 400.0;
  return 10.0 * std::sin(kWave_per_m * x_m) * std::cos(kWave_per_m * y_m);
}

std::string FaultIn(const std::string& text) {
  return MessageOf([&] { static_cast<void>(ElevationGrid(text, "dem.asc")); });
}

TEST(ElevationGrid, HasTheHeightsOfItsCellsAtTheirMiddles) {
  const auto height_m = [](double x_m, double y_m) {
    return std::fmod(7.0 * x_m + 3.0 * y_m, 50.0);
  };
  const ElevationGrid grid(GridOf(height_m), "dem.asc");
  for (const double x_m : {1015.0, 1135.0, 2185.0}) {
    for (const double y_m : {2015.0, 2465.0, 2885.0}) {
      EXPECT_NEAR(grid.Height_m(x_m, y_m), height_m(x_m, y_m), 1e-9);
    }
  }
  EXPECT_EQ(grid.cell_m(), 30.0);
}

TEST(ElevationGrid, TakesCornersAndMiddlesOfCells) {
  const ElevationGrid by_corner("ncols 2 nrows 2 xllcorner 0 yllcorner 0 cellsize 10\n1 2 3 4",
                                "dem.asc");
  const ElevationGrid by_middle("NCOLS 2 NROWS 2 XLLCENTER 5 YLLCENTER 5 DX 10 DY 10\n1 2 3 4",
                                "dem.asc");
  for (const ElevationGrid& grid : {by_corner, by_middle}) {
    EXPECT_DOUBLE_EQ(grid.Height_m(5.0, 5.0), 3.0);
    EXPECT_DOUBLE_EQ(grid.Height_m(15.0, 15.0), 2.0);
  }
}

// Cubic convolution is exact for polynomials of second degree.
TEST(ElevationGrid, IsExactForAQuadraticSurface) {
  const auto height_m = [](double x_m, double y_m) {
    const double x = (x_m - 1500.0) / 100.0;
    const double y = (y_m - 2400.0) / 100.0;
    return 3.0 + x - 2.0 * y + 0.5 * x * x - 0.7 * x * y + 0.3 * y * y;
  };
  const ElevationGrid grid(GridOf(height_m), "dem.asc");
  for (double x_m = 1050.0; x_m < 2150.0; x_m += 17.0) {
    for (double y_m = 2050.0; y_m < 2850.0; y_m += 13.0) {
      ASSERT_NEAR(grid.Height_m(x_m, y_m), height_m(x_m, y_m), 1e-9);
    }
  }
}

struct Errors {
  double height_m{};
  double slope{};
};
Errors ErrorsOf(const std::function<double(double, double)>& made) {
  constexpr double kStep_m = 0.01;
  const auto slope = [&](const auto& of, double x_m, double y_m) {
    return (of(x_m + kStep_m, y_m) - of(x_m - kStep_m, y_m)) / (2.0 * kStep_m);
  };
  Errors worst;
  for (double x_m = 1100.0; x_m < 2000.0; x_m += 3.1) {
    for (double y_m = 2100.0; y_m < 2800.0; y_m += 7.3) {
      worst.height_m = std::max(worst.height_m, std::abs(made(x_m, y_m) - WavyHeight_m(x_m, y_m)));
      worst.slope =
          std::max(worst.slope, std::abs(slope(made, x_m, y_m) - slope(WavyHeight_m, x_m, y_m)));
    }
  }
  return worst;
}

// Of hills 400 m long; bilinear interpolation, beside it, errs by up to cell^2 / 8 times the sum of
// both curvatures, 10 (2 pi / 400)^2 each: 0.55 m.
TEST(ElevationGrid, KeepsTheShapeOfHillsThatBilinearInterpolationLoses) {
  const ElevationGrid grid(GridOf(WavyHeight_m), "dem.asc");
  const Errors cubic = ErrorsOf([&](double x_m, double y_m) { return grid.Height_m(x_m, y_m); });
  const Errors bilinear =
      ErrorsOf([](double x_m, double y_m) { return Bilinear(WavyHeight_m, x_m, y_m); });
  RecordProperty("cubic", std::to_string(cubic.height_m) + " m, " + std::to_string(cubic.slope));
  RecordProperty("bilinear",
                 std::to_string(bilinear.height_m) + " m, " + std::to_string(bilinear.slope));
  EXPECT_LT(cubic.height_m, 0.03);
  EXPECT_LT(cubic.slope, 0.0065);
  EXPECT_GT(bilinear.height_m, 8.0 * cubic.height_m);
  EXPECT_GT(bilinear.slope, 4.0 * cubic.slope);
}

TEST(ElevationGrid, HasNoKinksBetweenCells) {
  const ElevationGrid grid(
      GridOf([](double x_m, double y_m) { return std::fmod(x_m * y_m, 20.0); }), "dem.asc");
  constexpr double kStep_m = 1e-4;
  for (double x_m = 1015.0; x_m < 2180.0; x_m += kCell_m) {
    const double here_m = grid.Height_m(x_m, 2333.0);
    const double before = (here_m - grid.Height_m(x_m - kStep_m, 2333.0)) / kStep_m;
    const double after = (grid.Height_m(x_m + kStep_m, 2333.0) - here_m) / kStep_m;
    EXPECT_NEAR(before, after, 1e-3);
  }
}

TEST(ElevationGrid, CoversItsCellsButThoseWithoutData) {
  std::string text =
      "ncols 4\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize 10\nNODATA_value -1\n"
      "5 5 5 5\n5 5 -1 5\n5 5 5 5\n";
  const ElevationGrid grid(text, "dem.asc");
  EXPECT_TRUE(grid.Covers(0.0, 0.0));
  EXPECT_TRUE(grid.Covers(14.0, 29.9));
  EXPECT_FALSE(grid.Covers(-0.1, 15.0));
  EXPECT_FALSE(grid.Covers(15.0, 30.1));
  EXPECT_FALSE(grid.Covers(24.0, 16.0));
  EXPECT_NEAR(grid.Height_m(24.0, 16.0), 5.0, 1e-12);
}

TEST(ElevationGrid, SaysWhatIsWrongWithAFile) {
  const std::string header = "ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 10\n";
  EXPECT_EQ(FaultIn(""), "dem.asc: must be an ESRI ASCII grid (got an empty file)");
  EXPECT_EQ(FaultIn("II*\n"),
            "dem.asc:1: must be a line of an ESRI ASCII grid's header, such as ncols or cellsize "
            "(got \"II*\")");
  EXPECT_EQ(FaultIn("ncols 3\nnrows 2\nxllcorner 0\ncellsize 10\n1 2 3 4 5 6"),
            "dem.asc: must have yllcorner or yllcenter in its header");
  EXPECT_EQ(FaultIn("ncols 3\nncols 2\n"), "dem.asc:2: ncols: is given twice");
  EXPECT_EQ(FaultIn("ncols 2.5\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 10\n1"),
            "dem.asc:1: ncols: must be a whole number from 2 to 1000000 (got 2.5)");
  EXPECT_EQ(FaultIn("ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 0\n1"),
            "dem.asc:5: cellsize: must be > 0 (got 0)");
  EXPECT_EQ(FaultIn(header + "1 2 3\n4 5\n"),
            "dem.asc: must have 6 heights, 3 in each of 2 rows (got 5)");
  EXPECT_EQ(FaultIn(header + "1 2 3\n4 5 6 7\n"),
            "dem.asc: must have 6 heights, 3 in each of 2 rows (got more)");
  EXPECT_EQ(FaultIn(header + "1 2 3\n4 5,5 6\n"), "dem.asc:7: not a number (got \"5,5\")");
  EXPECT_EQ(FaultIn(header + "1 2 3\n4 nan 6\n"), "dem.asc:7: not a number (got \"nan\")");
  EXPECT_EQ(FaultIn(header + "1 2 3\n4 2e5 6\n"),
            "dem.asc:7: must be a height from -100000 to 100000 m (got 2e+05)");
  EXPECT_EQ(FaultIn(header + "-9999 -9999 -9999 -9999 -9999 -9999"),
            "dem.asc: must have a height that is not missing (got none)");
}

// A header may announce 1e12 heights: nothing is allocated for them.
TEST(ElevationGrid, TakesNoMemoryForWhatAShortFileAnnounces) {
  EXPECT_EQ(FaultIn("ncols 1000000\nnrows 1000000\nxllcorner 0\nyllcorner 0\ncellsize 10\n1 2\n"),
            "dem.asc: must have 1000000000000 heights, 1000000 in each of 1000000 rows (got 2)");
}

TEST(ElevationGrid, RefusesDegrees) {
  EXPECT_EQ(FaultIn("ncols 2\nnrows 2\nxllcorner -84\nyllcorner 36\ncellsize 0.05\n1 2 3 4"),
            "dem.asc:5: cellsize: must be in metres; cells as small as this are those of a grid in "
            "degrees, which must be projected first (got 0.05)");
  EXPECT_EQ(FaultIn("ncols 2\nnrows 2\nxllcorner 4000\nyllcorner 36\ncellsize 0.05\n1 2 3 4"),
            "no error");
}

const std::filesystem::path kJacksboro =
    RAILCAST_SHARED_DATA_DIR "/dem_jacksboro/jacksboro_fault_dem.asc";

TEST(ElevationGrid, RefusesARealGridInDegreesAndReadsItInMetres) {
  if (!std::filesystem::exists(kJacksboro)) GTEST_SKIP() << "no " << kJacksboro;
  std::ifstream file(kJacksboro);
  std::string text(std::istreambuf_iterator<char>(file), {});
  EXPECT_EQ(FaultIn(text),
            "dem.asc:5: dx: must be in metres; cells as small as this are those of a grid in "
            "degrees, which must be projected first (got 0.000833333333)");
  // At 36.6 degrees north a cell has 74.4 m by 92.5 m.
  const auto replace = [&](const std::string& from, const std::string& to) {
    text.replace(text.find(from), from.size(), to);
  };
  replace("dx 0.000833333333", "dx 74.4");
  replace("dy 0.000833333333", "dy 92.5");
  replace("xllcorner -84.4137500000", "xllcorner 0");
  replace("yllcorner 36.4462500000", "yllcorner 0");
  const ElevationGrid grid(text, "dem.asc");
  // The first three heights of the first row, which is the northernmost.
  const double north_m = 92.5 * 343.5;
  EXPECT_NEAR(grid.Height_m(0.5 * 74.4, north_m), 483.0, 1e-9);
  EXPECT_NEAR(grid.Height_m(2.5 * 74.4, north_m), 491.0, 1e-9);
  double least_m = 1e9;
  double most_m = -1e9;
  for (double x_m = 40.0; x_m < 29900.0; x_m += 74.4) {
    for (double y_m = 50.0; y_m < 31700.0; y_m += 92.5) {
      least_m = std::min(least_m, grid.Height_m(x_m, y_m));
      most_m = std::max(most_m, grid.Height_m(x_m, y_m));
    }
  }
  // The file's range is 236 to 1076 m; the cubic overshoots by at most an eighth of the greatest
  // step between neighbours.
  EXPECT_NEAR(least_m, 236.0, 30.0);
  EXPECT_NEAR(most_m, 1076.0, 30.0);
}

}  // namespace
}  // namespace railcast
