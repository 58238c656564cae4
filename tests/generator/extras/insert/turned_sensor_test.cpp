// A recording of a sensor that lies on its side takes what the same recording takes upright.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <map>
#include <numbers>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/base/units.h"
#include "core/io/recording/found_sensor.h"
#include "core/io/write_file.h"
#include "generator/extras/insert/firing_finder.h"
#include "generator/extras/insert/packets/insertion.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/extras/insert/closed_loop.h"
#include "tests/generator/extras/insert/found_firings.h"
#include "tests/generator/extras/insert/plan/plan_project.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

constexpr double kYaw_deg = 20.0;

/// The points of a frame in other axes, in the order in which they were measured.
std::string CloudInAxes(const LoopSensor& sensor,
                        const Frame& frame,
                        const Eigen::Matrix3d& axes_from_sensor) {
  std::string bytes;
  for (std::size_t i = 0; i < sensor.pattern.num_firings(); ++i) {
    const std::size_t slot = sensor.pattern.row[i] * std::size_t{frame.width()} +
                             std::size_t{sensor.pattern.column[i]} * frame.returns;
    if (std::isnan(frame.x[slot])) continue;
    const Vector3 turned_m =
        axes_from_sensor * Vector3(frame.x[slot], frame.y[slot], frame.z[slot]);
    const Eigen::Vector4f values(static_cast<float>(turned_m.x()), static_cast<float>(turned_m.y()),
                                 static_cast<float>(turned_m.z()), frame.intensity[slot]);
    bytes.append(reinterpret_cast<const char*>(values.data()), 4 * sizeof(float));
  }
  const std::string num = std::to_string(bytes.size() / (4 * sizeof(float)));
  return "VERSION .7\nFIELDS x y z intensity\nSIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 1\nWIDTH " +
         num + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + num + "\nDATA binary\n" + bytes;
}

/// Axes that are turned by roll and yaw.
Eigen::Matrix3d SensorFromAxes(double roll_deg) {
  return RotationFromYawPitchRoll(RadFromDeg(kYaw_deg), 0.0, RadFromDeg(roll_deg));
}

/// Puts a crate into a cloud of a sensor, which is turned by roll and yaw and known by its points
/// alone.
/// @param how Keys of the plan, each with a comma behind it.
InsertedFrame InsertTurned(const LoopSensor& sensor,
                           const Frame& frame,
                           double roll_deg,
                           const std::string& how) {
  const TemporaryDirectory folder;
  const fs::path cloud = folder.path() / "turn.pcd";
  WriteFileWhole(cloud, CloudInAxes(sensor, frame, SensorFromAxes(roll_deg).transpose()));
  WriteFileWhole(folder.path() / "found.json", FindSensor(*OpenRecording(cloud)).FileText());
  const auto& [x_m, y_m, z_m] = sensor.scenario.lidar.mount.position_m;
  const std::string mount = R"({"position_m": [)" + std::to_string(x_m) + ", " +
                            std::to_string(y_m) + ", " + std::to_string(z_m) + R"(], "yaw_deg": )" +
                            std::to_string(kYaw_deg) + R"(, "roll_deg": )" +
                            std::to_string(roll_deg) + "}";
  const fs::path plan = WritePlan(
      folder.path(), R"({"poses": "standing"})",
      R"(, "objects": [{"name": "crate", "type": "box", "size_m": [2, 3, 3], "frame": 0, )"
      R"("s_m": 9, "d_m": 0, "h_m": 0}])",
      how + R"("lidar": {"file": "found.json", "mount": )" + mount + "}, ");
  InsertedFrame inserted = MakeInsertion(plan, cloud)((*OpenRecording(cloud)->Next())());
  EXPECT_EQ(inserted.recorded.frame.sensor_from_spin.has_value(), roll_deg != 0.0);
  return inserted;
}

TEST(FiringFinder, FollowsASensorThatLiesOnItsSide) {
  const ScanSpec scan = ReadSensor("vlp16");
  const ScanPattern pattern = BuildScanPattern(scan);
  const std::vector<MadeFiring> upright = FireInThePlain(pattern);
  std::vector<MadeFiring> turned = upright;
  for (MadeFiring& firing : turned) {
    std::ranges::rotate(firing.point_m, firing.point_m.begin() + 1);
  }
  const TemporaryDirectory folder;
  WriteCloudOf(turned, pattern, {}, folder.path() / "cloud.pcd");
  RecordedFirings found =
      FiringFinder({}, scan, false).Find((*OpenRecording(folder.path() / "cloud.pcd")->Next())());
  EXPECT_EQ(found.pattern.columns, pattern.columns);
  // Turned back, y z x becomes x y z.
  std::swap(found.pattern.direction_x, found.pattern.direction_z);
  std::swap(found.pattern.direction_y, found.pattern.direction_z);
  const AimErrors errors = ErrorsOf(upright, found);
  errors.Print("VLP-16 on its side");
  EXPECT_LE(AimErrors::Share(errors.with_point_deg, 1.0), 1e-3);
  EXPECT_LE(AimErrors::Share(errors.without_point_deg, 1.0), 0.1);
}

/// The points by row and azimuth, in steps: columns may begin one step beside each other.
std::map<std::pair<std::size_t, std::int64_t>, Vector3> PointsOf(
    const InsertedFrame& inserted,
    const Eigen::Matrix3d& sensor_from_axes,
    std::uint32_t num_columns) {
  std::map<std::pair<std::size_t, std::int64_t>, Vector3> points_m;
  const Frame& frame = inserted.recorded.frame;
  for (std::size_t i = 0; i < frame.num_slots(); ++i) {
    if (std::isnan(frame.x[i])) continue;
    const Vector3 point_m = sensor_from_axes * Vector3(frame.x[i], frame.y[i], frame.z[i]);
    const double turns = std::atan2(point_m.y(), point_m.x()) / (2.0 * std::numbers::pi);
    points_m[{i / frame.width(), std::llround((turns + 1.0) * num_columns) % num_columns}] =
        point_m;
  }
  return points_m;
}

class InsertionIntoATurnedSensor : public testing::Test {
 protected:
  InsertionIntoATurnedSensor() {
    sensor_.scenario.fidelity = Fidelity::kFootprint;  // Without noise across beams.
    // Lasers that fire at once leave no doubt which firings make a column.
    for (ChannelSpec& channel :
         std::get<SpinningSpec>(sensor_.scenario.lidar.scan.pattern).channels) {
      channel.time_us = 0.0;
    }
    sensor_.pattern = BuildScanPattern(sensor_.scenario.lidar.scan);
    frame_ = ScanLoop(sensor_, MakeLoopScene(sensor_.scenario));
  }

  LoopSensor sensor_{ReadMinimalWith("vlp16"), {}};
  Frame frame_;
};

TEST_F(InsertionIntoATurnedSensor, ChangesTheFiringsThatItChangesUpright) {
  const std::string exact = R"("fidelity": "geometry", )";
  const InsertedFrame upright = InsertTurned(sensor_, frame_, 0.0, exact);
  const InsertedFrame turned = InsertTurned(sensor_, frame_, 90.0, exact);
  ASSERT_EQ(turned.recorded.frame.num_slots(), upright.recorded.frame.num_slots());
  ASSERT_EQ(turned.edits.size(), upright.edits.size());
  EXPECT_GT(upright.edits.size(), 500U);
  const auto points_m = PointsOf(turned, SensorFromAxes(90.0), sensor_.pattern.columns);
  const auto expected_m = PointsOf(upright, SensorFromAxes(0.0), sensor_.pattern.columns);
  ASSERT_EQ(points_m.size(), expected_m.size());
  std::size_t num_apart = 0;
  for (const auto& [firing, point_m] : expected_m) {
    ASSERT_TRUE(points_m.contains(firing));
    // Float32 at 100 m, turned there and back.
    num_apart += (points_m.at(firing) - point_m).norm() > 1e-4;
  }
  // Firings without a return are known but for half a step where the turn begins and ends.
  EXPECT_LE(num_apart, 16U);
}

// Which of the firings of one time is the first to draw is decided by rounding.
TEST_F(InsertionIntoATurnedSensor, LetsFogTakeAsMuchAsUpright) {
  const std::string in_fog = R"("fidelity": "footprint", "weather": {"visibility_m": 100}, )";
  const auto num = [&](double roll_deg) {
    return static_cast<double>(InsertTurned(sensor_, frame_, roll_deg, in_fog).edits.size());
  };
  const double upright = num(0.0);
  EXPECT_GT(upright, 10'000.0);
  EXPECT_NEAR(num(90.0), upright, 4.0 * std::sqrt(2.0 * upright));
}

}  // namespace
}  // namespace railcast
