#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <filesystem>
#include <fstream>
#include <map>
#include <numbers>
#include <regex>
#include <set>
#include <sstream>
#include <utility>

#include "tests/core/scan/pattern_angles.h"
#include "tests/support/sensor_file.h"

namespace railcast {
namespace {

constexpr double kTable_deg = 1e-3;  // One unit of the last digit in the vendors' tables.

std::vector<ChannelSpec> ChannelsOf(const std::string& name) {
  return std::get<SpinningSpec>(ReadSensor(name).pattern).channels;
}

std::string ReadText(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

double FieldOf(const std::string& entry, const std::string& name) {
  std::smatch found;
  EXPECT_TRUE(std::regex_search(entry, found, std::regex(name + R"(:\s*([-+.\deE]+))")));
  return std::stod(found[1]);
}

struct Calibration {
  const char* sensor;
  const char* file;
  double cycle_us;
  std::uint32_t columns;
};

void PrintTo(const Calibration& calibration, std::ostream* out) {
  *out << calibration.sensor;
}

class VelodyneTable : public testing::TestWithParam<Calibration> {};

TEST_P(VelodyneTable, AgreesWithThePublishedCalibration) {
  const std::filesystem::path file =
      std::filesystem::path(RAILCAST_SHARED_DATA_DIR "/velodyne_calibration/ros-drivers") /
      GetParam().file;
  if (!exists(file)) GTEST_SKIP() << file << " is not there";
  const std::vector<ChannelSpec> channels = ChannelsOf(GetParam().sensor);
  const std::string text = ReadText(file);
  const std::regex entries(R"(\{([^}]*)\})");
  std::size_t num_lasers = 0;
  for (std::sregex_iterator entry(text.begin(), text.end(), entries), end; entry != end; ++entry) {
    const auto laser = static_cast<std::size_t>(FieldOf((*entry)[1], "laser_id"));
    ASSERT_LT(laser, channels.size());
    EXPECT_NEAR(channels[laser].elevation_deg, DegFromRad(FieldOf((*entry)[1], "vert_correction")),
                kTable_deg);
    EXPECT_NEAR(channels[laser].azimuth_deg, -DegFromRad(FieldOf((*entry)[1], "rot_correction")),
                kTable_deg);
    ++num_lasers;
  }
  EXPECT_EQ(num_lasers, channels.size());
}

INSTANTIATE_TEST_SUITE_P(SensorTables,
                         VelodyneTable,
                         testing::Values(Calibration{"vlp16", "VLP16db.yaml", 55.296, 1808},
                                         Calibration{"vlp16_20hz", "VLP16db.yaml", 55.296, 904},
                                         Calibration{"hdl32e", "32db.yaml", 46.08, 2170},
                                         Calibration{"vlp32c", "VeloView-VLP-32C.yaml", 55.296,
                                                     1808},
                                         Calibration{"vls128", "VLS128.yaml", 55.277, 1809}),
                         [](const auto& test) { return std::string(test.param.sensor); });

// Two unit vectors that turn against each other, of 9.6 deg each.
TEST(RosetteTable, IsThatOfTwoTurningPrisms) {
  const ScanPattern pattern = BuildScanPattern(
      {.rate_hz = 10.0,
       .pattern = FiringTableSpec{RAILCAST_SOURCE_DIR "/scenarios/sensors/rosette.csv"}});
  ASSERT_EQ(pattern.num_firings(), 10'000U);
  double widest_deg = 0.0;
  for (std::size_t i = 0; i < pattern.num_firings(); ++i) {
    ASSERT_EQ(pattern.time_ns[i], 10'000U * i);
    const double t_s = 1e-5 * static_cast<double>(i);
    const std::complex<double> deflection_deg =
        std::polar(9.6, 2.0 * std::numbers::pi * 121.3 * t_s) +
        std::polar(9.6, -2.0 * std::numbers::pi * 77.9 * t_s);
    const double azimuth_deg = DegFromRad(std::atan2(static_cast<double>(pattern.direction_y[i]),
                                                     static_cast<double>(pattern.direction_x[i])));
    const double elevation_deg = DegFromRad(std::asin(static_cast<double>(pattern.direction_z[i])));
    // Half a digit of the table, and directions in float32.
    ASSERT_NEAR(azimuth_deg, deflection_deg.real(), 0.51e-3);
    ASSERT_NEAR(elevation_deg, deflection_deg.imag(), 0.51e-3);
    widest_deg = std::max(widest_deg, std::abs(deflection_deg));
  }
  EXPECT_NEAR(widest_deg, 19.2, 0.01);
}

/// The field of view of a minute's frames of a sensor, every tenth.
struct View {
  double width_deg{};
  double height_deg{};
};

View ViewOf(const ScanPattern& pattern) {
  double left_deg = 0.0;
  double right_deg = 0.0;
  double top_deg = 0.0;
  double bottom_deg = 0.0;
  for (std::uint32_t frame = 0; frame < 600; frame += 10) {
    const ScanPattern of_frame = PatternOfFrame(pattern, frame);
    for (std::size_t i = 0; i < of_frame.num_firings(); ++i) {
      left_deg = std::max(left_deg, AzimuthInDegrees(of_frame, i));
      right_deg = std::min(right_deg, AzimuthInDegrees(of_frame, i));
      top_deg = std::max(top_deg, ElevationInDegrees(of_frame, i));
      bottom_deg = std::min(bottom_deg, ElevationInDegrees(of_frame, i));
    }
  }
  return {left_deg - right_deg, top_deg - bottom_deg};
}

struct LikeSensor {
  const char* name;
  std::size_t num_firings;
  View view;
};

class SensorWithPrisms : public testing::TestWithParam<LikeSensor> {};

// Points per second and fields of view are those that Livox states for the sensors.
TEST_P(SensorWithPrisms, HasTheViewAndThePointsOfItsModel) {
  const ScanPattern pattern = BuildScanPattern(ReadSensor(GetParam().name));
  EXPECT_FALSE(pattern.repeats());
  EXPECT_EQ(pattern.num_firings(), GetParam().num_firings);
  const View view = ViewOf(pattern);
  EXPECT_NEAR(view.width_deg, GetParam().view.width_deg, 0.1);
  EXPECT_NEAR(view.height_deg, GetParam().view.height_deg, 0.1);
}

INSTANTIATE_TEST_SUITE_P(SensorTables,
                         SensorWithPrisms,
                         testing::Values(LikeSensor{"mid40_like", 10'000, {38.4, 38.4}},
                                         LikeSensor{"tele15_like", 24'000, {14.5, 16.2}}),
                         [](const auto& test) { return std::string(test.param.name); });

using Cell = std::pair<int, int>;

/// The cells of 0.3 deg, by azimuth and elevation, into which a frame's beams go.
void AddCells(const ScanPattern& of_frame, std::set<Cell>& cells) {
  constexpr double kCell_deg = 0.3;
  for (std::size_t i = 0; i < of_frame.num_firings(); ++i) {
    const Cell cell(static_cast<int>(std::floor(AzimuthInDegrees(of_frame, i) / kCell_deg)),
                    static_cast<int>(std::floor(ElevationInDegrees(of_frame, i) / kCell_deg)));
    const double from_axis_deg = kCell_deg * std::hypot(cell.first + 0.5, cell.second + 0.5);
    if (from_axis_deg < 19.2) cells.insert(cell);
  }
}

// The shares were found by a script of a few lines, which refracts the beams one by one and knows
// nothing of frames.
TEST(Mid40Like, CoversItsViewBitByBit) {
  const ScanPattern pattern = BuildScanPattern(ReadSensor("mid40_like"));
  std::set<Cell> cells;
  constexpr double kNumCells = 12892.0;
  const std::map<std::uint32_t, double> shares = {{0, 0.213}, {1, 0.386}, {4, 0.734}, {9, 0.945}};
  for (std::uint32_t frame = 0; frame < 10; ++frame) {
    AddCells(PatternOfFrame(pattern, frame), cells);
    const auto share = shares.find(frame);
    if (share == shares.end()) continue;
    // Rounded to 0.001; some beams on the edges of cells are rounded otherwise.
    EXPECT_NEAR(static_cast<double>(cells.size()) / kNumCells, share->second, 0.002) << frame;
  }
}

ScanPattern Aeries2Pattern() {
  return BuildScanPattern(
      {.rate_hz = 10.0,
       .pattern = FiringTableSpec{RAILCAST_SOURCE_DIR "/scenarios/sensors/aeries2.csv"}});
}

// Of Aeva's own simulation (ScanPatterns.yaml, "64-19.2-Uniform"): four beams move in 16 steps,
// with 3051 points over 144 deg in each sweep, of which the sensor sees the middle 120 deg. Four
// sweeps of lines adjoin each other, so that some of their rows interleave.
TEST(Aeries2Table, SweepsFourLinesAtATimeAsItsMakersSimulationDoes) {
  const ScanPattern pattern = Aeries2Pattern();
  constexpr std::size_t kPoints = 2543;
  constexpr std::array kBeams_deg = {-1.718873, -0.5729578, 0.5729578, 1.718873};
  constexpr std::array kSteps_deg = {-7.8, -7.5, -7.2, -6.9, -3.0, -2.7, -2.4, -2.1,
                                     1.8,  2.1,  2.4,  2.7,  6.6,  6.9,  7.2,  7.5};
  ASSERT_EQ(pattern.rows, 64U);
  ASSERT_EQ(pattern.columns, kPoints);
  for (std::size_t i = 0; i < pattern.num_firings(); ++i) {
    const std::size_t sweep = i / (4 * kPoints);
    const std::size_t point = i / 4 % kPoints;
    ASSERT_EQ(pattern.time_ns[i], 6'250'000 * sweep + 2'048 * point);
    ASSERT_NEAR(AzimuthInDegrees(pattern, i),
                (1271.0 - static_cast<double>(point)) * 144.0 / 3051.0, kTable_deg);
    ASSERT_NEAR(ElevationInDegrees(pattern, i), kBeams_deg.at(i % 4) + kSteps_deg.at(sweep),
                kTable_deg);
  }
}

// 0.5 m x 1.75 m at 56 m, before the middle of the view, are 0.512 x 1.79 deg. Of the lines, five
// are within 0.895 deg of the middle (those of the steps -2.4, -2.1, 1.8, 2.1 and 2.4), and each
// has 10.8 points in the width.
TEST(Aeries2Table, HasTheBeamsOnAPersonThatItsResolutionSays) {
  const ScanPattern pattern = Aeries2Pattern();
  std::size_t num_hits = 0;
  for (std::size_t i = 0; i < pattern.num_firings(); ++i) {
    const double scale = 56.0 / static_cast<double>(pattern.direction_x[i]);
    num_hits += std::abs(scale * static_cast<double>(pattern.direction_y[i])) < 0.25 &&
                std::abs(scale * static_cast<double>(pattern.direction_z[i])) < 0.875;
  }
  EXPECT_EQ(num_hits, 5U * 11U);
}

TEST(PandarTable, AgreesWithThePublishedCalibration) {
  std::ifstream file(RAILCAST_SHARED_DATA_DIR "/lidar_packets_nebula/calibration/Pandar64.csv");
  if (!file) GTEST_SKIP() << "Pandar64.csv is not there";
  const std::vector<ChannelSpec> channels = ChannelsOf("pandar64");
  std::string line;
  std::getline(file, line);
  std::size_t num_lasers = 0;
  for (; std::getline(file, line); ++num_lasers) {
    unsigned id = 0;
    double elevation_deg = 0.0;
    double azimuth_deg = 0.0;
    ASSERT_EQ(std::sscanf(line.c_str(), "%u,%lf,%lf", &id, &elevation_deg, &azimuth_deg), 3);
    EXPECT_NEAR(channels.at(id - 1).elevation_deg, elevation_deg, kTable_deg);
    EXPECT_NEAR(channels.at(id - 1).azimuth_deg, azimuth_deg, kTable_deg);
  }
  EXPECT_EQ(num_lasers, channels.size());
}

TEST(PandarTable, FiresChannelsInPairsWithinTheCycle) {
  // From 54.668 us to 3.620 us before the end of the block.
  std::map<double, int> num_at_us;
  for (const ChannelSpec& channel : ChannelsOf("pandar64")) ++num_at_us[channel.time_us];
  EXPECT_EQ(num_at_us.size(), 32U);
  EXPECT_EQ(num_at_us.begin()->first, 0.0);
  EXPECT_EQ(num_at_us.rbegin()->first, 51.048);
  for (const auto& [time_us, count] : num_at_us) EXPECT_EQ(count, 2) << time_us;
}

std::filesystem::path HesaiTableFile(const std::string& name) {
  return std::filesystem::path(RAILCAST_SHARED_DATA_DIR "/lidar_hesai/calibration") / name;
}

/// Returns the numbers of a table's lines after `num_headers` lines.
std::vector<std::vector<double>> RowsOf(const std::filesystem::path& file, int num_headers) {
  std::ifstream lines(file);
  std::vector<std::vector<double>> rows;
  std::string line;
  for (int i = 0; std::getline(lines, line); ++i) {
    if (i < num_headers) continue;
    std::ranges::replace(line, ',', ' ');
    std::istringstream fields(line);
    std::vector<double>& row = rows.emplace_back();
    for (double value = 0.0; fields >> value;) row.push_back(value);
  }
  return rows;
}

TEST(Xt32Table, AgreesWithThePublishedCalibration) {
  const auto file = HesaiTableFile("nebula_PandarXT32.csv");
  if (!exists(file)) GTEST_SKIP() << file << " is not there";
  const std::vector<ChannelSpec> channels = ChannelsOf("xt32");
  const auto angles = RowsOf(file, 1);
  const auto times = RowsOf(HesaiTableFile("sdk_PandarXT-32_Firetime_Correction_File.csv"), 1);
  ASSERT_EQ(angles.size(), channels.size());
  ASSERT_EQ(times.size(), channels.size());
  for (std::size_t i = 0; i < channels.size(); ++i) {
    EXPECT_EQ(channels[i].elevation_deg, angles[i].at(1));
    EXPECT_EQ(channels[i].azimuth_deg, angles[i].at(2));
    EXPECT_NEAR(channels[i].time_us, times[i].at(1) - times[0].at(1), 1e-9);
  }
}

/// A sensor of which only the angles are published as a file.
struct AngleTable {
  const char* sensor;
  const char* file;
};

void PrintTo(const AngleTable& table, std::ostream* out) {
  *out << table.sensor;
}

class HesaiAngles : public testing::TestWithParam<AngleTable> {};

TEST_P(HesaiAngles, AgreeWithThePublishedCalibration) {
  const std::filesystem::path file =
      std::filesystem::path(RAILCAST_SHARED_DATA_DIR "/hesai_calibration") / GetParam().file;
  if (!exists(file)) GTEST_SKIP() << file << " is not there";
  const auto angles = RowsOf(file, 1);
  const std::vector<ChannelSpec> channels = ChannelsOf(GetParam().sensor);
  ASSERT_EQ(angles.size(), channels.size());
  for (std::size_t i = 0; i < channels.size(); ++i) {
    EXPECT_EQ(channels[i].elevation_deg, angles[i].at(1));
    EXPECT_EQ(channels[i].azimuth_deg, angles[i].at(2));
  }
}

INSTANTIATE_TEST_SUITE_P(SensorTables,
                         HesaiAngles,
                         testing::Values(AngleTable{"pandar40p", "Pandar40P.csv"},
                                         AngleTable{"qt64", "PandarQT64.csv"},
                                         AngleTable{"xt16", "PandarXT16.csv"},
                                         AngleTable{"xt32m", "PandarXT32M.csv"},
                                         AngleTable{"pandar128e4x_standard", "Pandar128E4X.csv"}),
                         [](const auto& test) { return std::string(test.param.sensor); });

TEST(Xt32mTable, HasTheMakersTimes) {
  const auto file = HesaiTableFile("sdk_PandarXT-32M2X_Firetime_Correction_File.csv");
  if (!exists(file)) GTEST_SKIP() << file << " is not there";
  const auto times = RowsOf(file, 1);
  const std::vector<ChannelSpec> channels = ChannelsOf("xt32m");
  ASSERT_EQ(times.size(), channels.size());
  for (std::size_t i = 0; i < channels.size(); ++i) {
    EXPECT_NEAR(channels[i].time_us, times[i].at(1) - times[0].at(1), 1e-9);
  }
}

TEST(Pandar128e4xTable, FiresEightCentralLasersAtATime) {
  std::map<double, std::vector<std::size_t>> lasers_at_us;
  const std::vector<ChannelSpec> channels = ChannelsOf("pandar128e4x");
  // Those of azimuth state 0: 12 outer lasers above the 64 central ones.
  ASSERT_EQ(channels.size(), 192U);
  for (std::size_t i = 12; i < 76; ++i) lasers_at_us[channels[i].time_us].push_back(i);
  EXPECT_EQ(lasers_at_us.size(), 8U);
  for (const auto& [time_us, lasers] : lasers_at_us) EXPECT_EQ(lasers.size(), 8U) << time_us;
}

// The maker's table has the 96 lasers of each loop and their times since that loop began.
TEST(Qt128Table, AgreesWithTheMakersTables) {
  const auto file = HesaiTableFile("sdk_QT128C2X_Angle_Correction_File.csv");
  if (!exists(file)) GTEST_SKIP() << file << " is not there";
  const auto angles = RowsOf(file, 1);
  ASSERT_EQ(angles.size(), 128U);
  std::vector<ChannelSpec> expected;
  const auto times = RowsOf(HesaiTableFile("sdk_QT128C2X_Firetime_Correction_File.csv"), 3);
  for (std::size_t loop = 0; loop < 2; ++loop) {
    std::map<std::size_t, double> fired_us;
    for (const std::vector<double>& row : times) {
      if (row.empty() || row.at(2 * loop) == 0.0) continue;
      fired_us[static_cast<std::size_t>(row[2 * loop]) - 1] = row.at(2 * loop + 1);
    }
    EXPECT_EQ(fired_us.size(), 96U);
    for (const auto& [laser, us] : fired_us) {
      const double time_us = us - 0.6 + 111.111 * static_cast<double>(loop);
      expected.push_back({angles.at(laser).at(1), angles[laser].at(2), time_us});
    }
  }
  const std::vector<ChannelSpec> channels = ChannelsOf("qt128");
  ASSERT_EQ(channels.size(), expected.size());
  for (std::size_t i = 0; i < channels.size(); ++i) {
    EXPECT_EQ(channels[i].elevation_deg, expected[i].elevation_deg);
    EXPECT_EQ(channels[i].azimuth_deg, expected[i].azimuth_deg);
    EXPECT_NEAR(channels[i].time_us, expected[i].time_us, 1e-9);
  }
}

class SensorTable : public testing::TestWithParam<Calibration> {};

TEST_P(SensorTable, MakesAWholeTurnWithinThePeriod) {
  const ScanSpec spec = ReadSensor(GetParam().sensor);
  const auto& spinning = std::get<SpinningSpec>(spec.pattern);
  const ScanPattern pattern = BuildScanPattern(spec);
  EXPECT_EQ(pattern.columns, GetParam().columns);
  EXPECT_EQ(pattern.num_firings(), spinning.channels.size() * GetParam().columns);
  EXPECT_NEAR(spinning.cycle_us, GetParam().cycle_us, 1e-9);
  EXPECT_TRUE(std::ranges::is_sorted(pattern.time_ns));
  EXPECT_EQ(pattern.time_ns.front(), 0U);
  const double period_us = 1e6 / spec.rate_hz;
  EXPECT_LT(pattern.time_ns.back(), 1e3 * period_us);
  // Another cycle would not fit.
  EXPECT_GT((pattern.columns + 1) * spinning.cycle_us, period_us);
}

TEST_P(SensorTable, FillsEveryCellOnceWithDirectionsOfUnitLengthThatRiseWithTheRow) {
  const ScanPattern pattern = BuildScanPattern(ReadSensor(GetParam().sensor));
  std::vector<int> num_in_cell(std::size_t{pattern.rows} * pattern.columns);
  std::vector<double> elevation_deg(pattern.rows);
  for (std::size_t i = 0; i < pattern.num_firings(); ++i) {
    ++num_in_cell[std::size_t{pattern.row[i]} * pattern.columns + pattern.column[i]];
    elevation_deg[pattern.row[i]] = ElevationInDegrees(pattern, i);
    ASSERT_NEAR(Direction(pattern, i).squaredNorm(), 1.0, 1.2e-7);
  }
  EXPECT_TRUE(std::ranges::all_of(num_in_cell, [](int count) { return count == 1; }));
  // Two firings of a laser of QT128 or Pandar128E4X have one elevation.
  for (std::size_t i = 1; i < elevation_deg.size(); ++i) {
    EXPECT_GT(elevation_deg[i], elevation_deg[i - 1] - kFloatAngle_deg);
  }
}

INSTANTIATE_TEST_SUITE_P(SensorTables,
                         SensorTable,
                         testing::Values(Calibration{"vlp16", "", 55.296, 1808},
                                         Calibration{"vlp16_20hz", "", 55.296, 904},
                                         Calibration{"hdl32e", "", 46.08, 2170},
                                         Calibration{"hdl64e", "", 48.0, 2083},
                                         Calibration{"vlp32c", "", 55.296, 1808},
                                         Calibration{"pandar64", "", 1e6 / 18000.0, 1800},
                                         Calibration{"vls128", "", 55.277, 1809},
                                         Calibration{"xt32", "", 50.0, 2000},
                                         Calibration{"qt128", "", 1e6 / 4500.0, 450},
                                         Calibration{"pandar128e4x", "", 1e6 / 18000.0, 1800},
                                         Calibration{"pandar128e4x_standard", "", 1e6 / 18000.0,
                                                     1800},
                                         Calibration{"pandar40p", "", 1e6 / 18000.0, 1800},
                                         Calibration{"qt64", "", 1e6 / 6000.0, 600},
                                         Calibration{"xt16", "", 50.0, 2000},
                                         Calibration{"xt32m", "", 50.0, 2000}),
                         [](const auto& test) { return std::string(test.param.sensor); });

TEST(SensorTables, Vlp16TurnsByTheAngleOfTwoCyclesFromBlockToBlock) {
  const ScanPattern pattern = BuildScanPattern(ReadSensor("vlp16"));
  // A real capture has 0.398 deg per block.
  constexpr double kBlock_deg = 2.0 * 55.296e-6 * 3600.0;
  EXPECT_NEAR(kBlock_deg, 0.398, 5e-4);
  for (std::size_t block = 1; block < 904; ++block) {
    const double turned_deg =
        AzimuthInDegrees(pattern, 32 * (block - 1)) - AzimuthInDegrees(pattern, 32 * block);
    ASSERT_NEAR(std::remainder(turned_deg, 360.0), kBlock_deg, 2.0 * kFloatAngle_deg);
  }
}

}  // namespace
}  // namespace railcast
