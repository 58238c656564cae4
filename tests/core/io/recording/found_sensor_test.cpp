// Sensors found in nothing but x, y and z, against the beams that captures state.
#include "core/io/recording/found_sensor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

#include "core/base/input_file.h"
#include "core/base/random.h"
#include "core/base/text.h"
#include "core/base/units.h"
#include "core/io/write_file.h"
#include "railcast/scenario.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/recording/read_all.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/support/sensor_file.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

/// A firing of a known sensor.
struct KnownFiring {
  Vector3 direction = Vector3::UnitX();
  Vector3 point_m = Vector3::Zero();  ///< 0 = no return.
  std::uint32_t row{};
};

/// What of the sensor was found.
struct FoundAgain {
  FoundSensor sensor;
  std::size_t num_rings{};  ///< That have a point.
  double share_without_return{};
  double most_elevation_off_deg{};
  double azimuth_rms_deg{}, empty_azimuth_rms_deg{};
  double share_beside{};  ///< Share of the firings more than 0.02 deg beside.
};

/// The points as a file of KITTI's, which has neither rings nor times, read again.
RecordedFrame HiddenFrame(const std::vector<KnownFiring>& firings) {
  std::string bytes;
  for (const KnownFiring& firing : firings) {
    if (firing.point_m.isZero()) continue;
    const Eigen::Vector4f values(static_cast<float>(firing.point_m.x()),
                                 static_cast<float>(firing.point_m.y()),
                                 static_cast<float>(firing.point_m.z()), 0.5F);
    bytes.append(reinterpret_cast<const char*>(values.data()), 4 * sizeof(float));
  }
  const TemporaryDirectory directory;
  WriteFileWhole(directory.path() / "000000.bin", bytes);
  return ReadAll(directory.path() / "000000.bin").front();
}

/// The row of the grid that has most of the points of each row.
std::map<std::uint32_t, std::size_t> RowsAgain(const std::vector<KnownFiring>& firings,
                                               const RecordedFrame& found) {
  std::map<std::uint32_t, std::map<std::size_t, std::size_t>> votes;
  std::size_t entry = 0;
  for (const KnownFiring& firing : firings) {
    if (firing.point_m.isZero()) continue;
    ++votes[firing.row][found.slot_of_entry[entry++] / found.frame.width()];
  }
  std::map<std::uint32_t, std::size_t> rows;
  for (const auto& [row, of_row] : votes) {
    rows[row] =
        std::ranges::max_element(of_row, {}, [](const auto& vote) { return vote.second; })->first;
  }
  return rows;
}

/// Azimuths of a row of the found beams, with those between columns that no point has.
std::vector<double> AzimuthsOf(const ScanTable& beams, std::size_t row) {
  std::vector<double> azimuths_rad;
  double last_rad = std::nan("");
  for (const double column_rad : beams.column_azimuth_rad) {
    const double way_rad = std::isnan(last_rad) ? 0.0 : column_rad - last_rad;
    const double num = std::max(1.0, std::round(std::abs(way_rad) / beams.column_step_rad));
    for (double i = num - 1.0; i >= 0.0; i -= 1.0) {
      azimuths_rad.push_back(
          WrappedAngle_rad(column_rad - way_rad * i / num + beams.row_azimuth_rad[row]));
    }
    last_rad = column_rad;
  }
  std::ranges::sort(azimuths_rad);
  return azimuths_rad;
}

double NearestOff_rad(const std::vector<double>& sorted_rad, double azimuth_rad) {
  const auto above = std::ranges::lower_bound(sorted_rad, azimuth_rad);
  double least_rad = std::min(std::abs(WrappedAngle_rad(sorted_rad.front() - azimuth_rad)),
                              std::abs(WrappedAngle_rad(sorted_rad.back() - azimuth_rad)));
  if (above != sorted_rad.end()) least_rad = std::min(least_rad, *above - azimuth_rad);
  if (above != sorted_rad.begin()) least_rad = std::min(least_rad, azimuth_rad - *(above - 1));
  return least_rad;
}

FoundAgain FindAgain(const std::vector<KnownFiring>& firings) {
  const RecordedFrame hidden = HiddenFrame(firings);
  FoundAgain again{.sensor = FindSensor(hidden)};
  const auto rows = RowsAgain(firings, hidden);
  again.num_rings = rows.size();
  std::map<std::uint32_t, std::vector<double>> azimuths_rad;
  for (const auto& [row, found_row] : rows) {
    azimuths_rad[row] = AzimuthsOf(again.sensor.beams, found_row);
  }
  double num = 0.0, num_empty = 0.0, num_beside = 0.0, squares = 0.0, empty_squares = 0.0;
  for (const KnownFiring& firing : firings) {
    if (!rows.contains(firing.row)) continue;
    const double elevation_rad = std::asin(firing.direction.z());
    const double up_rad = again.sensor.beams.elevation_rad[rows.at(firing.row)] - elevation_rad;
    again.most_elevation_off_deg =
        std::max(again.most_elevation_off_deg, std::abs(DegFromRad(up_rad)));
    const double off_deg = DegFromRad(NearestOff_rad(
        azimuths_rad[firing.row], std::atan2(firing.direction.y(), firing.direction.x())));
    const bool is_empty = firing.point_m.isZero();
    (is_empty ? num_empty : num) += 1.0;
    (is_empty ? empty_squares : squares) += off_deg * off_deg;
    constexpr double kBeside_deg = 0.02;
    num_beside += off_deg > kBeside_deg ? 1.0 : 0.0;
  }
  again.share_without_return = num_empty / (num + num_empty);
  again.azimuth_rms_deg = std::sqrt(squares / num);
  again.empty_azimuth_rms_deg = std::sqrt(empty_squares / num_empty);
  again.share_beside = num_beside / (num + num_empty);
  return again;
}

std::vector<KnownFiring> FiringsOfTurn(const RecordedFrame& recorded) {
  const Frame& frame = recorded.frame;
  std::vector<KnownFiring> firings;
  for (std::uint32_t row = 0; row < frame.rows; ++row) {
    for (std::uint32_t column = 0; column < frame.columns; ++column) {
      KnownFiring firing{.direction = recorded.beam_of(row, column).direction, .row = row};
      const std::size_t first = (std::size_t{row} * frame.columns + column) * frame.returns;
      for (std::size_t slot = first; slot < first + frame.returns; ++slot) {
        if (std::isnan(frame.x[slot])) continue;
        firing.point_m = {frame.x[slot], frame.y[slot], frame.z[slot]};
        break;
      }
      firings.push_back(firing);
    }
  }
  return firings;
}

/// A capture and its fullest turn.
struct HiddenCapture {
  const char* file;
  std::size_t turn;
};
constexpr HiddenCapture kCaptures[] = {
    {"lidar_hesai/captures/qt128.db3", 1},
    {"lidar_hesai/captures/xt32.db3", 1},
    {"lidar_hesai_more/40p.db3", 1},
    {"lidar_hesai_more/qt64.db3", 1},
    {"lidar_ouster/OS-1-128_v2.3.0_1024x10_lb_n3.pcap", 0},
    {"lidar_ouster/OS-2-128-U1_v2.3.0_1024x10.pcap", 0},
    {"lidar_packets_nebula/pandar64.pcap", 1},
    {"lidar_packets_nebula/vlp16_dual.pcap", 1},
    {"lidar_packets_nebula/vlp32c_single.pcap", 1},
    {"lidar_packets_nebula/vls128_single.pcap", 1},
    {"lidar_velodyne_more/hdl32e.pcap", 1},
    {"ouster_more/OS-0-128-U1_v2.3.0_1024x10.pcap", 0},
    {"ouster_more/OS-0-32-U1_v2.2.0_1024x10.pcap", 0},
    {"ouster_more/OS-2-32-U0_v2.0.0_1024x10.pcap", 0},
};

fs::path SharedFile(const char* file) {
  return fs::path(RAILCAST_SHARED_DATA_DIR) / file;
}

std::string Decimals(double value) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(3) << value;
  return text.str();
}

std::string RowOfPage(const HiddenCapture& capture, const FoundAgain& again) {
  return "| " + fs::path(capture.file).filename().string() + " | " +
         NumberText(again.sensor.pattern.channels.size()) + " of " + NumberText(again.num_rings) +
         " | " + Decimals(again.sensor.step_deg) + " | " + Decimals(again.most_elevation_off_deg) +
         " | " + Decimals(again.azimuth_rms_deg) + " | " + Decimals(again.empty_azimuth_rms_deg) +
         " | " + Decimals(100.0 * again.share_beside) + " | " +
         Decimals(100.0 * again.sensor.share_without_return) + " | " +
         Decimals(100.0 * again.share_without_return) + " |\n";
}

// The table of docs/results/found_sensors.md is made from what is found here:
//   RAILCAST_WRITE_FOUND=1 build/ci/tests/core/io/io_tests --gtest_filter='FoundSensor.IsThat*'
TEST(FoundSensor, IsThatOfEveryCaptureAsThePageSays) {
  std::string table;
  for (const HiddenCapture& capture : kCaptures) {
    SCOPED_TRACE(capture.file);
    const fs::path file = SharedFile(capture.file);
    if (!exists(file)) GTEST_SKIP() << file << " is not there";
    const FoundAgain again = FindAgain(FiringsOfTurn(ReadAll(file)[capture.turn]));
    EXPECT_EQ(again.sensor.pattern.channels.size(), again.num_rings);
    EXPECT_LT(again.most_elevation_off_deg, 0.005);
    EXPECT_LT(again.azimuth_rms_deg, 0.02);
    EXPECT_LT(again.empty_azimuth_rms_deg, 0.02);
    EXPECT_NEAR(again.sensor.share_without_return, again.share_without_return, 0.001);
    EXPECT_EQ(again.sensor.num_lost, 0U);
    table += RowOfPage(capture, again);
  }
  const std::string page_file = RAILCAST_SOURCE_DIR "/docs/results/found_sensors.md";
  const std::string page = ReadFileWhole(page_file);
  constexpr std::string_view kBegin = "<!-- found sensors -->\n";
  const std::size_t begin = page.find(kBegin) + kBegin.size();
  const std::size_t rows = page.find("|---", begin);
  const std::size_t first = page.find('\n', rows) + 1;
  const std::string expected =
      page.substr(0, first) + table + page.substr(page.find("<!-- end of found sensors -->"));
  if (std::getenv("RAILCAST_WRITE_FOUND") != nullptr) {
    std::ofstream(page_file) << expected;
  } else {
    EXPECT_TRUE(page == expected) << "the table of " << page_file << " must be\n" << table;
  }
}

/// Firings of a sensor in a room without end: ground 1.73 m below, and walls 8 to 60 m away.
std::vector<KnownFiring> MadeFirings(const SpinningSpec& sensor, const Vector3& origin_m) {
  std::vector<KnownFiring> firings;
  for (std::uint32_t column = 0; column < sensor.columns; ++column) {
    for (std::uint32_t row = 0; row < sensor.channels.size(); ++row) {
      const ChannelSpec& channel = sensor.channels[row];
      const double turned_deg =
          360.0 * (column + channel.time_us / sensor.cycle_us) / sensor.columns;
      const double azimuth_rad = -RadFromDeg(turned_deg + channel.azimuth_deg);
      const double elevation_rad = RadFromDeg(channel.elevation_deg);
      const double level = std::cos(elevation_rad);
      KnownFiring firing{.direction = {level * std::cos(azimuth_rad), level * std::sin(azimuth_rad),
                                       std::sin(elevation_rad)},
                         .row = row};
      const Vector3 from_m =
          Eigen::AngleAxisd(-RadFromDeg(turned_deg), Vector3::UnitZ()) * origin_m;
      const double wall_m = 34.0 + 26.0 * std::sin(5.0 * azimuth_rad) * std::cos(2.0 * azimuth_rad);
      const double ground_m = (-1.73 - from_m.z()) / firing.direction.z();
      const double range_m = ground_m > 0.0 ? std::min(wall_m, ground_m) : wall_m;
      const auto words = RandomWords(7, RandomUse::kNoise, column, row);
      if (UnitFloat(words[0]) > 0.2F) firing.point_m = from_m + range_m * firing.direction;
      firings.push_back(firing);
    }
  }
  return firings;
}

TEST(FoundSensor, IsTheHdl64EOfACloudLikeKittis) {
  const auto sensor = std::get<SpinningSpec>(ReadSensor("hdl64e").pattern);
  const FoundAgain again = FindAgain(MadeFirings(sensor, Vector3::Zero()));
  EXPECT_EQ(again.sensor.pattern.channels.size(), 64U);
  EXPECT_FALSE(again.sensor.pattern.beam_origin_m.has_value());
  EXPECT_NEAR(again.sensor.step_deg, 360.0 / sensor.columns, 1e-4);
  // float32 at 60 m is known to 4e-6 m; the elevation of points 8 m away to 3e-5 deg.
  EXPECT_LT(again.most_elevation_off_deg, 1e-4);
  EXPECT_LT(again.azimuth_rms_deg, 1e-3);
  EXPECT_LT(again.empty_azimuth_rms_deg, 1e-3);
  EXPECT_NEAR(again.sensor.share_without_return, again.share_without_return, 1e-6);
  EXPECT_EQ(again.sensor.num_lost, 0U);
}

TEST(FoundSensor, HasTheOriginOfItsBeams) {
  const auto sensor = std::get<SpinningSpec>(ReadSensor("hdl64e").pattern);
  const FoundAgain again = FindAgain(MadeFirings(sensor, {0.03, 0.0, 0.12}));
  EXPECT_EQ(again.sensor.pattern.channels.size(), 64U);
  ASSERT_TRUE(again.sensor.pattern.beam_origin_m.has_value());
  EXPECT_NEAR((*again.sensor.pattern.beam_origin_m)[0], 0.03, 1e-3);
  EXPECT_NEAR((*again.sensor.pattern.beam_origin_m)[1], 0.12, 1e-3);
  EXPECT_LT(again.most_elevation_off_deg, 0.005);
  EXPECT_LT(again.azimuth_rms_deg, 0.02);
}

TEST(FoundSensor, HasBeamsThatLeaveOnTheAxisWhereOnlyTheirHeightIsShown) {
  const auto sensor = std::get<SpinningSpec>(ReadSensor("hdl64e").pattern);
  const FoundAgain again = FindAgain(MadeFirings(sensor, {0.0, 0.0, 0.12}));
  EXPECT_EQ(again.sensor.pattern.channels.size(), 64U);
  ASSERT_TRUE(again.sensor.pattern.beam_origin_m.has_value());
  EXPECT_EQ((*again.sensor.pattern.beam_origin_m)[0], 0.0);
  EXPECT_NEAR((*again.sensor.pattern.beam_origin_m)[1], 0.12, 1e-3);
  EXPECT_LT(again.azimuth_rms_deg, 0.02);
}

TEST(FoundSensor, HasTheRateAndTheFiringTimesOfTimedPoints) {
  const fs::path file = SharedFile("lidar_hesai/captures/xt32.db3");
  if (!exists(file)) GTEST_SKIP() << file << " is not there";
  const FoundSensor found = FindSensor(ReadAll(file)[1]);
  const auto preset = std::get<SpinningSpec>(ReadSensor("xt32").pattern);
  EXPECT_TRUE(found.has_times);
  EXPECT_NEAR(found.rate_hz, 10.0, 0.05);
  EXPECT_EQ(found.pattern.rotation, Rotation::kClockwise);
  // Channels of the preset fall, those that are found rise.
  std::vector<double> off_us, off_deg;
  for (std::size_t i = 0; i < 32; ++i) {
    off_us.push_back(found.pattern.channels[i].time_us - preset.channels[31 - i].time_us);
    off_deg.push_back(found.pattern.channels[i].azimuth_deg - preset.channels[31 - i].azimuth_deg);
  }
  const auto [least_us, most_us] = std::ranges::minmax(off_us);
  const auto [least_deg, most_deg] = std::ranges::minmax(off_deg);
  EXPECT_LT(most_us - least_us, 1.0);
  EXPECT_LT(most_deg - least_deg, 0.01);
}

TEST(FoundSensor, IsWrittenAsAFileThatScenariosTake) {
  const auto sensor = std::get<SpinningSpec>(ReadSensor("vlp16").pattern);
  const FoundSensor found = FindAgain(MadeFirings(sensor, {0.03, 0.0, 0.12})).sensor;
  const TemporaryDirectory directory;
  WriteFileWhole(directory.path() / "found.json", found.FileText());
  const ScenarioSpec scenario = ReadScenarioText(
      R"({"version": 1, "lidar": "found.json", "world": {"alignment": {"course": {"type": )"
      R"("elements", "elements": [{"type": "straight", "length_m": 100}]}}}, "materials": ")" RAILCAST_SOURCE_DIR
      R"(/scenarios/materials/railway.json", "labels": ")" RAILCAST_SOURCE_DIR
      R"(/scenarios/labels.json"})",
      directory.path() / "scenario.json");
  EXPECT_EQ(std::get<SpinningSpec>(scenario.lidar.scan.pattern), found.pattern);
  EXPECT_NO_THROW((void)BuildScanPattern(scenario.lidar.scan));
}

/// The same firings of a sensor that is turned, with ranges that are read in millimetres.
std::vector<KnownFiring> Turned(std::vector<KnownFiring> firings, const Eigen::Matrix3d& rotation) {
  for (KnownFiring& firing : firings) {
    if (!firing.point_m.isZero()) {
      const double range_m = firing.point_m.norm();
      firing.point_m += (1e-3 * std::round(1e3 * range_m) - range_m) * firing.direction;
    }
    firing.direction = rotation * firing.direction;
    firing.point_m = rotation * firing.point_m;
  }
  return firings;
}

/// The largest angle between the beams of points as they were and as they are found.
double MostBeside_deg(const std::vector<KnownFiring>& firings,
                      const RecordedFrame& recorded,
                      const FoundSensor& found) {
  double most_rad = 0.0;
  std::size_t entry = 0;
  for (const KnownFiring& firing : firings) {
    if (firing.point_m.isZero()) continue;
    const std::size_t cell = recorded.slot_of_entry[entry++] / recorded.frame.returns;
    const auto [x, y, z] =
        found.beams.Direction(cell / recorded.frame.columns, cell % recorded.frame.columns);
    most_rad = std::max(most_rad, firing.direction.cross(Vector3(x, y, z)).norm());
  }
  return DegFromRad(most_rad);
}

class AxisOfFoundSensor : public testing::TestWithParam<Vector3> {};

TEST_P(AxisOfFoundSensor, MakesNoDifferenceToItsBeams) {
  const Vector3 axis = GetParam().normalized();
  const Eigen::Matrix3d rotation =
      Eigen::Quaterniond::FromTwoVectors(Vector3::UnitZ(), axis).toRotationMatrix();
  const auto sensor = std::get<SpinningSpec>(ReadSensor("vlp16").pattern);
  for (const Vector3& origin_m : {Vector3(0.0, 0.0, 0.0), Vector3(0.012, 0.0, 0.036)}) {
    const std::vector<KnownFiring> firings = MadeFirings(sensor, origin_m);
    const RecordedFrame upright = HiddenFrame(firings);
    const FoundSensor standing = FindSensor(upright);
    EXPECT_FALSE(standing.sensor_from_spin.has_value());
    const std::vector<KnownFiring> turned = Turned(firings, rotation);
    const RecordedFrame recorded = HiddenFrame(turned);
    const FoundSensor found = FindSensor(recorded);
    ASSERT_TRUE(found.sensor_from_spin.has_value());
    EXPECT_LT(DegFromRad(found.sensor_from_spin->col(2).cross(axis).norm()), 0.001);
    EXPECT_GT(found.sensor_from_spin->col(2).dot(axis), 0.0);
    ASSERT_EQ(found.pattern.channels.size(), standing.pattern.channels.size());
    for (std::size_t i = 0; i < standing.pattern.channels.size(); ++i) {
      EXPECT_NEAR(found.pattern.channels[i].elevation_deg,
                  standing.pattern.channels[i].elevation_deg, 2e-4);
    }
    EXPECT_NEAR(found.step_deg, standing.step_deg, 1e-5);
    EXPECT_EQ(found.pattern.rotation, standing.pattern.rotation);
    EXPECT_EQ(found.share_without_return, standing.share_without_return);
    EXPECT_LT(MostBeside_deg(turned, recorded, found),
              MostBeside_deg(firings, upright, standing) + 0.001);
    const auto found_m = found.pattern.beam_origin_m.value_or(std::array{0.0, 0.0});
    EXPECT_NEAR(found_m[0], origin_m.x(), 1e-4);
    EXPECT_NEAR(found_m[1], origin_m.z(), 1e-4);
  }
}

INSTANTIATE_TEST_SUITE_P(Axes,
                         AxisOfFoundSensor,
                         testing::Values(Vector3(1.0, 0.0, 0.0),
                                         Vector3(0.0, -1.0, 0.0),
                                         Vector3(0.966, 0.0, -0.259),
                                         Vector3(0.05, -0.03, 1.0),
                                         Vector3(-0.4, 0.7, 0.55)));

TEST(FoundSensor, OfALevelAxisSaysSoAndIsWrittenAsIfItStood) {
  const auto sensor = std::get<SpinningSpec>(ReadSensor("vlp16").pattern);
  const std::vector<KnownFiring> firings = MadeFirings(sensor, Vector3::Zero());
  const Eigen::Matrix3d rotation = RotationFromYawPitchRoll(0.0, RadFromDeg(75.0), 0.0);
  const FoundSensor found = FindSensor(HiddenFrame(Turned(firings, rotation)));
  EXPECT_EQ(found.AxisText(), "[0.966, 0, 0.259]");
  EXPECT_EQ(FindSensor(HiddenFrame(firings)).AxisText(), "");
  EXPECT_EQ(found.FileText().find("mount"), std::string::npos);
}

TEST(FoundSensor, OfAnOrganisedCloudMayLieOnItsSide) {
  const auto sensor = std::get<SpinningSpec>(ReadSensor("vlp16").pattern);
  const Eigen::Matrix3d rotation = RotationFromYawPitchRoll(0.0, 0.0, RadFromDeg(-90.0));
  const std::vector<KnownFiring> firings = Turned(MadeFirings(sensor, Vector3::Zero()), rotation);
  std::string pcd =
      "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 16\nHEIGHT " +
      std::to_string(sensor.columns) + "\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " +
      std::to_string(firings.size()) + "\nDATA binary\n";
  for (const KnownFiring& firing : firings) {
    const Eigen::Vector3f point_m = firing.point_m.cast<float>();
    pcd.append(reinterpret_cast<const char*>(point_m.data()), sizeof(point_m));
  }
  const TemporaryDirectory directory;
  WriteFileWhole(directory.path() / "turn.pcd", pcd);
  const RecordedFrame recorded = ReadAll(directory.path() / "turn.pcd").front();
  EXPECT_EQ(recorded.frame.rows, 16U);
  const FoundSensor found = FindSensor(recorded);
  EXPECT_EQ(found.AxisText(), "[0, 1, 0]");
  EXPECT_EQ(found.pattern.channels.size(), 16U);
  EXPECT_NEAR(found.pattern.channels.front().elevation_deg, -15.0, 1e-3);
  EXPECT_LT(found.azimuth_error_deg, 0.001);
}

/// A real frame of an OS1-64 that lies on its side, with its axis; none: its origin is elsewhere.
struct SideFrame {
  const char* file;
  const char* axis;
};

TEST(FoundSensor, IsTheOs1Of64RingsOfRealFramesAboutLevelAxes) {
  for (const auto& [name, axis] :
       std::initializer_list<SideFrame>{{"Jesenice1.pc", "[0, 0.966, -0.259]"},
                                        {"Jesenice2.pc", "[0, -0.966, -0.259]"},
                                        {"JesenicePartialObstacle.pc", "[0, 0.966, 0.259]"},
                                        {"Vienna.csv", "[0, -0.257, 0.967]"},
                                        {"Vizmarje.pc", "[1, 0, 0]"},
                                        {"Vizmarje2.pc", "[1, 0, 0]"},
                                        {"Vizmarje3.pc", "[1, 0, 0]"}}) {
    SCOPED_TRACE(name);
    const fs::path file = SharedFile("railway_frames") / name;
    if (!exists(file)) GTEST_SKIP() << file << " is not there";
    const FoundSensor found = FindSensor(*OpenRecording(file));
    EXPECT_EQ(found.AxisText(), axis);
    EXPECT_EQ(found.pattern.channels.size(), 64U);
    EXPECT_NEAR(found.step_deg, 360.0 / 2048.0, 1e-5);
    EXPECT_LT(found.elevation_error_deg, 1e-4);
    EXPECT_LT(found.azimuth_error_deg, 5e-4);
    ASSERT_TRUE(found.pattern.beam_origin_m.has_value());
    EXPECT_NEAR((*found.pattern.beam_origin_m)[0], 0.01215, 5e-5);  // The maker says 12.163 mm.
  }
}

TEST(FoundSensor, IsNoneOfARealFrameWhoseOriginWasMoved) {
  const fs::path file = SharedFile("railway_frames/JeseniceFullObstacle.pc");
  if (!exists(file)) GTEST_SKIP() << file << " is not there";
  EXPECT_EQ(
      MessageOf([&] { (void)FindSensor(*OpenRecording(file)); }),
      "no spinning sensor is found: it has no field ring, and its elevations do not form rings");
}

TEST(FoundSensor, IsNoneOfSensorsThatDoNotSpin) {
  const fs::path at128 = SharedFile("hesai_calibration/at128_1679653308704927652.pcd");
  if (!exists(at128)) GTEST_SKIP() << at128 << " is not there";
  EXPECT_EQ(
      MessageOf([&] { (void)FindSensor(*OpenRecording(at128)); }),
      "no spinning sensor is found: it has no field ring, and its elevations do not form rings");
}

}  // namespace
}  // namespace railcast
