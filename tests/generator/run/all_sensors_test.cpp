#include "generator/run/all_sensors.h"

#include <gtest/gtest.h>
#include <pcl/console/print.h>
#include <pcl/io/pcd_io.h>
#include <pcl/point_cloud.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/io/run/sensors_record.h"
#include "core/io/run/sequence_files.h"
#include "railcast/io/cloud_files.h"
#include "railcast/io/recording.h"
#include "railcast/scenario.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/example_run.h"
#include "tests/generator/run_command.h"
#include "tests/support/exits_with.h"

/// A point as PCL's own reader fills it.
struct MergedPoint {
  float x, y, z;
  std::uint32_t time_ns;
  std::uint8_t sensor_index;
};
POINT_CLOUD_REGISTER_POINT_STRUCT(MergedPoint,
                                  (float, x, x)(float, y, y)(float, z, z)  //
                                  (std::uint32_t, time_ns, time_ns)        //
                                  (std::uint8_t, sensor_index, sensor_index))

namespace railcast {
namespace {

namespace fs = std::filesystem;
using Points = pcl::PointCloud<MergedPoint>;

const fs::path kScenarios = fs::path(RAILCAST_SOURCE_DIR) / "scenarios";
constexpr std::int64_t kMs = 1'000'000;

// PCL warns where the cloud of a single sensor has no sensor_index.
Points Read(const fs::path& file) {
  pcl::console::setVerbosityLevel(pcl::console::L_ERROR);
  Points points;
  EXPECT_EQ(pcl::io::loadPCDFile(file.string(), points), 0) << file;
  return points;
}

Points OfSensor(const Points& all, int sensor_index) {
  Points points;
  for (const MergedPoint& point : all) {
    if (point.sensor_index == sensor_index) points.push_back(point);
  }
  return points;
}

class MergedClouds : public testing::Test {
 protected:
  /// Makes a run of two_sensors.json: `front` of 20 Hz and, `roof_phase_s` later, `roof` of 10 Hz.
  /// @param of_roof Further keys of the roof's sensor.
  [[nodiscard]] Ended Make(const std::string& out,
                           const std::string& options,
                           double roof_phase_s = 0.0,
                           const std::string& of_roof = "") const {
    std::ofstream(folder_.path() / "scenario.json")
        << R"({"version": 1, "file": ")" << (kScenarios / "two_sensors.json").string()
        << R"(", "lidars": [{"file": ")" << (kScenarios / "sensors/vlp16_20hz.json").string()
        << R"(", "name": "front", "mount": {"position_m": [2.2, 0, 2.5], "yaw_deg": 90}},)"
        << R"({"file": ")" << (kScenarios / "sensors/vlp16.json").string()
        << R"(", "name": "roof", "mount": {"position_m": [1.5, 0, 4.1]}, "phase_s": )"
        << roof_phase_s << of_roof << "}]}";
    return Generate("sequence " + (folder_.path() / "scenario.json").string() + " --out " +
                    Out(out).string() + " " + options);
  }
  [[nodiscard]] fs::path Out(const std::string& out) const { return folder_.path() / out; }

  const TemporaryDirectory folder_;
};

TEST_F(MergedClouds, HoldThePointsOfEverySensorInTheVehiclesAxes) {
  ASSERT_THAT(Make("run", "--frames 3 --merged --fields x,y,z,time_ns"), ExitsWith(0));
  const Points merged = Read(Out("run/merged/frames/000002.pcd"));
  // The vehicle is turned by a quarter against the sensor at the front.
  const Points front = OfSensor(merged, 0);
  std::size_t at = 0;
  for (const MergedPoint& point : Read(Out("run/front/frames/000002.pcd"))) {
    if (std::isnan(point.x)) continue;
    ASSERT_LT(at, front.size());
    ASSERT_NEAR(front[at].x, 2.2F - point.y, 1e-5F);
    ASSERT_NEAR(front[at].y, point.x, 1e-5F);
    ASSERT_NEAR(front[at].z, 2.5F + point.z, 1e-5F);
    ASSERT_EQ(front[at++].time_ns, point.time_ns);
  }
  EXPECT_EQ(at, front.size());
  EXPECT_GT(at, 1000U);
  const Points roof = OfSensor(merged, 1);
  at = 0;
  for (const MergedPoint& point : Read(Out("run/roof/frames/000001.pcd"))) {
    if (std::isnan(point.x)) continue;
    ASSERT_LT(at, roof.size());
    ASSERT_NEAR(roof[at].x, 1.5F + point.x, 1e-5F);
    ASSERT_NEAR(roof[at++].z, 4.1F + point.z, 1e-5F);
  }
  EXPECT_EQ(at, roof.size());
  EXPECT_GT(at, 1000U);
  // The one on the roof begins only every other frame.
  EXPECT_EQ(OfSensor(Read(Out("run/merged/frames/000001.pcd")), 1).size(), 0U);
}

TEST_F(MergedClouds, AreARecordingWithTheirNumbersPosesAndBoxes) {
  ASSERT_THAT(Make("run", "--frames 2 --start-frame 6 --stride 4 --merged"), ExitsWith(0));
  const auto merged = OpenRecording(Out("run/merged/"));
  const auto front = OpenRecording(Out("run/front"));
  EXPECT_EQ(merged->info().kind, "merged clouds");
  EXPECT_EQ(merged->info().scenario->lidar.name, "merged");
  EXPECT_EQ(merged->info().num_frames, 2U);
  ASSERT_TRUE(merged->info().scenario);
  EXPECT_EQ(merged->info().labels.labels(), front->info().labels.labels());
  const Transform vehicle_from_front = VehicleFromSensor(front->info().scenario->lidar.mount);
  for (const std::uint32_t index : {6U, 10U}) {
    const RecordedFrame all = (*merged->Next())();
    const RecordedFrame alone = (*front->Next())();
    EXPECT_EQ(all.frame.index, index);
    EXPECT_EQ(all.frame.stamp_ns, alone.frame.stamp_ns);
    EXPECT_EQ(all.frame.duration_ns, alone.frame.duration_ns);
    ASSERT_TRUE(all.has_pose);
    EXPECT_TRUE((all.frame.world_from_sensor * vehicle_from_front)
                    .isApprox(alone.frame.world_from_sensor, 1e-9));
    EXPECT_TRUE((all.frame.world_from_sensor_end * vehicle_from_front)
                    .isApprox(alone.frame.world_from_sensor_end, 1e-9));
    ASSERT_EQ(all.objects.size(), alone.objects.size());
    ASSERT_FALSE(all.objects.empty());
    for (std::size_t i = 0; i < all.objects.size(); ++i) {
      EXPECT_EQ(all.objects[i].name, alone.objects[i].name);
      EXPECT_TRUE(all.objects[i].sensor_from_box.isApprox(
          vehicle_from_front * alone.objects[i].sensor_from_box, 1e-9));
      EXPECT_GE(all.objects[i].points, alone.objects[i].points);
    }
  }
  EXPECT_FALSE(merged->Next());
}

TEST_F(MergedClouds, AreNamedWhereTheFolderAboveIsOpened) {
  const auto message = [&] { return MessageOf([&] { (void)OpenRecording(Out("run")); }); };
  ASSERT_EQ(Make("run", "--frames 1").status, 0);
  const std::string run = Out("run").string();
  const std::string sensors =
      run + ": holds several sensors; must be one of " + run + "/front, " + run + "/roof";
  EXPECT_EQ(message(), sensors);
  ASSERT_EQ(Make("run", "--frames 1 --merged").status, 0);
  EXPECT_EQ(message(), sensors + ", " + run + "/merged");
}

TEST_F(MergedClouds, AreARecordingWithoutTheirSensorsToo) {
  ASSERT_EQ(Make("run", "--frames 1 --start-frame 6 --merged").status, 0);
  fs::rename(Out("run/merged"), Out("moved"));
  const auto merged = OpenRecording(Out("moved"));
  EXPECT_FALSE(merged->info().scenario);
  const RecordedFrame frame = (*merged->Next())();
  EXPECT_EQ(frame.frame.index, 6U);
  EXPECT_TRUE(frame.has_pose);
  std::ofstream(Out("moved/frames/000006.pcd"), std::ios::app) << "more";
  EXPECT_THROW((void)(*OpenRecording(Out("moved"))->Next())(), InputError);
}

TEST_F(MergedClouds, CountTimesFromTheFirstSensorsStamp) {
  ASSERT_THAT(Make("run", "--frames 2 --merged --fields x,y,z,time_ns", 0.06), ExitsWith(0));
  EXPECT_TRUE(ReadFileWhole(Out("run/roof/poses.csv")).find("\n60000000,") != std::string::npos);
  EXPECT_EQ(OfSensor(Read(Out("run/merged/frames/000000.pcd")), 1).size(), 0U);
  // Frame 1 of the front begins after 50 ms, that of the roof 10 ms later and lasts 0.1 s.
  for (const MergedPoint& point : OfSensor(Read(Out("run/merged/frames/000001.pcd")), 1)) {
    ASSERT_GE(point.time_ns, 10 * kMs);
    ASSERT_LT(point.time_ns, 110 * kMs);
  }
  const std::string lines = ReadFileWhole(Out("run/merged/merged.jsonl"));
  EXPECT_NE(lines.find(R"({"sensor":"roof","frame":0,"later_ns":10000000})"), std::string::npos);
}

TEST_F(MergedClouds, LeaveTheSequencesAsTheyAre) {
  ASSERT_EQ(Make("merged", "--frames 2 --merged --format pcd-compressed").status, 0);
  ASSERT_EQ(Make("alone", "--frames 2 --format pcd-compressed").status, 0);
  EXPECT_EQ(Contents(Out("merged/front")), Contents(Out("alone/front")));
  EXPECT_EQ(Contents(Out("merged/roof")), Contents(Out("alone/roof")));
  EXPECT_FALSE(MergedFolderIn(Out("alone")));
  EXPECT_EQ(MergedFolderIn(Out("merged")).value().folder, Out("merged/merged"));
  // Clouds can be merged afterwards, too.
  ASSERT_EQ(Make("alone", "--frames 2 --format pcd-compressed --merged --threads 1").status, 0);
  EXPECT_EQ(Contents(Out("alone")), Contents(Out("merged")));
}

TEST_F(MergedClouds, AreMadeAgainIfTheyWereNotFinished) {
  const std::string options = "--frames 2 --merged --fields x,y,z";
  ASSERT_EQ(Make("whole", options).status, 0);
  ASSERT_EQ(Make("broken", options).status, 0);
  fs::remove(Out("broken/sensors.json"));
  fs::remove(Out("broken/merged/merged.jsonl"));
  std::ofstream(Out("broken/merged/frames/000001.pcd")) << "half";
  ASSERT_EQ(Make("broken", options).status, 0);
  EXPECT_EQ(Contents(Out("broken")), Contents(Out("whole")));
  fs::remove(Out("broken/merged/merged.jsonl"));
  std::ofstream(Out("broken/merged/photo.jpg")) << "mine";
  EXPECT_NE(Make("broken", options)
                .said.find("/merged: must hold nothing but merged clouds (got \"photo.jpg\")"),
            std::string::npos);
  std::ofstream(Out("whole/merged/frames/photo.jpg")) << "mine";
  EXPECT_NE(
      Make("whole", options)
          .said.find("/merged/frames: must hold nothing but merged clouds (got \"photo.jpg\")"),
      std::string::npos);
}

TEST_F(MergedClouds, NeedSeveralSensorsAndCoordinates) {
  EXPECT_EQ(Make("run", "--merged --sensor roof").said,
            "--merged: must be with several sensors (got one)\n");
  EXPECT_EQ(Make("run", "--merged --format ply").said,
            "--merged: must be with --format pcd or pcd-compressed (got ply)\n");
  EXPECT_EQ(Make("run", "--merged --fields x,y,label").said,
            "--merged: must be with --fields x, y and z (got x,y,label)\n");
  EXPECT_FALSE(fs::exists(Out("run")));
}

TEST_F(MergedClouds, NeedTheFieldsThatAllSensorsHave) {
  const std::string velocity = R"(, "velocity": {"sigma_mps": 0.03, "max_mps": 50})";
  EXPECT_EQ(Make("run", "--merged", 0.0, velocity).said,
            "--merged: must be with --fields that all sensors have (got " +
                FieldSelection("all", true).Text() + ")\n");
  EXPECT_EQ(Make("run", "--fields x,y,z,radial_velocity_mps", 0.0, velocity).said,
            "--fields: must be a field of a sensor without lidar.velocity (got "
            "\"radial_velocity_mps\")\n");
  EXPECT_FALSE(fs::exists(Out("run")));
  // Sequences of their own may differ.
  EXPECT_EQ(Make("run", "--frames 1", 0.0, velocity).status, 0);
}

TEST(MergedFrames, HoldWhatBeginsDuringAFrameOfTheFirstSensor) {
  const auto pattern_of = [](double rate_hz, double phase_s) {
    return BuildScanPattern(
        {.rate_hz = rate_hz, .pattern = RasterSpec{10.0, 10.0, 1.0}, .phase_s = phase_s});
  };
  const ScanPattern slow = pattern_of(10.0, 0.0);
  const ScanPattern fast = pattern_of(25.0, 0.01);
  SensorPlan first;
  first.spec.start_frame = 1;
  first.spec.num_frames = 2;
  first.spec.stride = 2;
  SensorPlan other;
  other.spec.start_frame = 3;
  other.spec.num_frames = 5;
  const std::vector<MergedSensor> sensors = {{first, slow}, {other, fast}};
  // The others begin after 130, 170, 210, 250 and 290 ms.
  using Parts = std::vector<MergedFrame::Part>;
  const MergedFrame frame = MergedFrameOf(sensors, 0), next = MergedFrameOf(sensors, 1);
  EXPECT_EQ(frame.stamp_ns, 100 * kMs);
  EXPECT_EQ(frame.parts, (Parts{{0, 1, 0}, {1, 3, 30'000'000}, {1, 4, 70'000'000}}));
  EXPECT_EQ(next.stamp_ns, 300 * kMs);
  EXPECT_EQ(next.parts, (Parts{{0, 3, 0}}));
}

}  // namespace
}  // namespace railcast
