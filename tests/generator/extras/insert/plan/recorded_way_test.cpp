#include "generator/extras/insert/plan/recorded_way.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <numbers>
#include <string>
#include <vector>

#include "core/io/write_file.h"
#include "generator/extras/insert/plan/plan_check.h"
#include "generator/extras/insert/plan/recorded_line.h"
#include "generator/extras/insert/plan/recorded_run.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/recording/made_sequence.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/extras/insert/plan/plan_project.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::IsEmpty;

/// The way of a received recording, or what is wrong with it.
struct ReadWay {
  explicit ReadWay(const std::vector<PosedCloud>& clouds) {
    const fs::path source = WriteReceived(folder.path() / "run", clouds);
    message = MessageOf([&] {
      way = ReadRecordedWay(source, {}, {}, remarks);
      line = LineOfWay(way, "run");
    });
    const std::size_t at = message.find(folder.path().string());
    if (at != message.npos) message.erase(at, folder.path().string().size() + 5);
  }

  TemporaryDirectory folder;
  RecordedWay way;
  RecordedLine line;
  std::vector<std::string> remarks;
  std::string message;
};

TEST(RecordedWay, InterpolatesPlaceAndRotationEvenlyAndGoesOnBeyondTheEnds) {
  RecordedWay way;
  const Transform turned = MakeTransform(RotationFromYawPitchRoll(0.4, 0.0, 0.0), {10, 4, 0});
  way.poses = {{0, Transform::Identity()}, {100, turned}};
  const Transform middle = way.WorldFromVehicle(50);
  EXPECT_LT((middle.translation() - Vector3(5, 2, 0)).norm(), 1e-12);
  EXPECT_TRUE(middle.linear().isApprox(RotationFromYawPitchRoll(0.2, 0.0, 0.0)));
  EXPECT_TRUE(way.WorldFromVehicle(100).isApprox(turned));
  EXPECT_LT((way.WorldFromVehicle(150).translation() - Vector3(15, 6, 0)).norm(), 1e-12);
  EXPECT_LT((way.WorldFromVehicle(-50).translation() - Vector3(-5, -2, 0)).norm(), 1e-12);
  way.is_held = true;
  EXPECT_TRUE(way.WorldFromVehicle(99).isApprox(Transform::Identity()));
  EXPECT_TRUE(way.WorldFromVehicle(100).isApprox(turned));
}

TEST(RecordedWay, RefusesPosesThatJump) {
  std::vector<PosedCloud> clouds = StraightRun(5, 20.0);
  clouds[3].position_m.y() = 80.0;
  EXPECT_EQ(ReadWay(clouds).message,
            "cloud.pcd: pose: must not jump: at most 150 m/s from the one before it (got 80.02 m "
            "in 0.1 s)");
  clouds = StraightRun(5, 20.0);
  clouds[2].heading_rad = std::numbers::pi / 2.0;
  EXPECT_EQ(ReadWay(clouds).message,
            "cloud.pcd: pose: must not jump: at most 3 rad/s from the one before it (got 90 deg in "
            "0.1 s)");
}

TEST(RecordedWay, RefusesTimesThatRunBackwards) {
  std::vector<PosedCloud> clouds = StraightRun(5, 20.0);
  clouds[3].time_s -= 0.25;
  EXPECT_EQ(ReadWay(clouds).message,
            "cloud.pcd: stamp: must be after that of the frame before it (got -0.15 s after it)");
}

TEST(RecordedWay, SaysWhereNothingWasRecorded) {
  std::vector<PosedCloud> clouds = StraightRun(8, 20.0);
  EXPECT_THAT(ReadWay(clouds).remarks, IsEmpty());
  for (std::size_t i = 5; i < clouds.size(); ++i) clouds[i].time_s += 3.0;
  const ReadWay read(clouds);
  ASSERT_EQ(read.remarks.size(), 1U);
  EXPECT_EQ(read.remarks[0].substr(0, 54),
            "1 gap in the recording's times, the one of 3.1 s befor");
}

TEST(RecordedWay, RefusesAxesThatAreNotTheVehicles) {
  std::vector<PosedCloud> clouds = StraightRun(30, 20.0);
  for (PosedCloud& cloud : clouds) cloud.heading_rad = std::numbers::pi / 2.0;
  EXPECT_EQ(
      ReadWay(clouds).message,
      "run: the vehicle must move along its x axis (got 0 m of 58 m): its axes are x forward, "
      "y left, z up, and lidar.mount says where the sensor is in them");
}

TEST(RecordedWay, TakesPosesAndTimesOfKitti) {
  const TemporaryDirectory folder;
  const fs::path sequence = folder.path() / "sequences/00";
  fs::create_directories(sequence / "velodyne");
  const std::array<float, 4> point = {5.0F, 1.0F, -1.0F, 0.5F};
  for (const std::string name : {"000000.bin", "000001.bin"}) {
    WriteFileWhole(sequence / "velodyne" / name,
                   std::string(reinterpret_cast<const char*>(point.data()), sizeof(point)));
  }
  // A camera looks along the velodyne's x axis: its x is right, y down, z forward.
  WriteFileWhole(sequence / "calib.txt",
                 "P0: 1 0 0 0 0 1 0 0 0 0 1 0\nTr: 0 -1 0 0 0 0 -1 0 1 0 0 0\n");
  WriteFileWhole(sequence / "poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 -0.5 0 1 0 0 0 0 1 2\n");
  WriteFileWhole(sequence / "times.txt", "0\n1.037e-01\n");
  std::vector<std::string> remarks;
  LidarSpec lidar;
  lidar.mount.position_m = {0.0, 0.0, 0.0};
  const RecordedWay way = ReadRecordedWay(folder.path(), {}, lidar, remarks);
  EXPECT_THAT(way.frame_times_ns, ElementsAre(0, 103'700'000));
  EXPECT_TRUE(way.at_frames[1].translation().isApprox(Vector3(2.0, 0.5, 0.0)));
  EXPECT_TRUE(way.is_held);  // KITTI's clouds are in the axes of one time each.
  const RecordedWay of_clouds = ReadRecordedWay(sequence / "velodyne/", {}, lidar, remarks);
  EXPECT_THAT(of_clouds.frame_times_ns, ElementsAre(0, 103'700'000));
  WriteFileWhole(sequence / "poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 -0.5 0 1 0 0 0 0 2\n");
  EXPECT_EQ(MessageOf([&] { (void)ReadRecordedWay(folder.path(), {}, lidar, remarks); }),
            (sequence / "poses.txt").string() + ":2: must be the 12 numbers of a pose");
  WriteFileWhole(sequence / "poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n");
  EXPECT_EQ(
      MessageOf([&] { (void)ReadRecordedWay(folder.path(), {}, lidar, remarks); }),
      (sequence / "poses.txt").string() + ": must have a line for each of the 2 frames (got 1)");
}

TEST(RecordedWay, EstimatesPosesByLayingCloudsOnEachOther) {
  const TemporaryDirectory folder;
  const MadeSequence made = MakeSequence(
      folder.path() / "run",
      {.object = R"({"name": "w", "type": "open_wagon", "s_m": 290, "d_m": 6})", .num_frames = 4});
  const LidarSpec& lidar = made.scenario.lidar;
  std::vector<std::string> remarks;
  const RecordedWay recorded = ReadRecordedWay(folder.path() / "run", {}, lidar, remarks);
  EXPECT_THAT(remarks, IsEmpty());
  const RecordedWay estimated =
      ReadRecordedWay(folder.path() / "run", {.poses = PoseSource::kRegistered}, lidar, remarks);
  ASSERT_EQ(remarks.size(), 1U);
  EXPECT_EQ(remarks[0].substr(0, 25), "the poses are an estimate");
  const auto way_m = [](const RecordedWay& way) -> Vector3 {
    return (way.at_frames[0].inverse() * way.at_frames[3]).translation();
  };
  EXPECT_LT((way_m(estimated) - way_m(recorded)).norm(), 0.3);
  EXPECT_TRUE(estimated.at_frames[0].isApprox(Transform::Identity()));
}

TEST(RecordedLine, GoesOnStraightAtTheTangentAndTheGradientOfItsEnds) {
  std::vector<PosedCloud> clouds;
  constexpr double kRadius_m = 400.0;
  for (int i = 0; i <= 100; ++i) {
    const double turn_rad = 0.0025 * i;
    clouds.push_back(
        {0.1 * i,
         Vector3{kRadius_m * std::sin(turn_rad), kRadius_m * (1.0 - std::cos(turn_rad)),
                 2.5 + 0.02 * kRadius_m * turn_rad},
         turn_rad});
  }
  const ReadWay read(clouds);
  ASSERT_EQ(read.message, "no error");
  EXPECT_NEAR(read.line.at_frames_m.back() - read.line.zero_s_m, 100.0, 1e-2);
  const Alignment alignment(read.line.alignment);
  const AxisPoint end = alignment.At(read.line.zero_s_m + 150.0);
  EXPECT_NEAR(end.heading_rad, 0.25, 1e-3);
  const Vector3 tangent(std::cos(0.25), std::sin(0.25), 0.0);
  const Vector3 last = clouds.back().position_m - Vector3(0, 0, 2.5);
  EXPECT_LT((end.position_m - (last + 50.0 * tangent + Vector3(0, 0, 1.0))).norm(), 0.1);
  const AxisPoint on_way = alignment.At(read.line.at_frames_m[50]);
  EXPECT_LT((on_way.position_m - (clouds[50].position_m - Vector3(0, 0, 2.5))).norm(), 0.01);
}

TEST(RecordedLine, RefusesAVehicleThatTurnsBack) {
  std::vector<PosedCloud> clouds = StraightRun(45, 20.0);
  for (std::size_t i = 30; i < clouds.size(); ++i) {
    clouds[i].position_m.x() = 118.0 - 2.0 * static_cast<double>(i);
  }
  EXPECT_EQ(ReadWay(clouds).message,
            "run: frame 39: the vehicle must not turn back on its way; the plan must give the line "
            "as /world/recording/alignment");
}

/// Whether the traits of a recording change with a file of it that keeps its size.
bool ChangesWith(const fs::path& recording, const fs::path& file) {
  const std::string before = RecordingTraits(recording);
  std::string bytes = ReadFileWhole(file);
  bytes.back() = static_cast<char>(bytes.back() ^ 1);
  WriteFileWhole(file, bytes);
  return RecordingTraits(recording) != before;
}

TEST(RecordingTraits, ChangeWithTheContentOfEveryFileThatIsRead) {
  const TemporaryDirectory folder;
  const auto write = [&](const char* name) {
    const fs::path file = folder.path() / name;
    fs::create_directories(file.parent_path());
    WriteFileWhole(file, "content");
    return file;
  };
  const fs::path clouds = write("clouds/0.pcd").parent_path();
  EXPECT_TRUE(ChangesWith(clouds, write("clouds/1.pcd")));
  EXPECT_TRUE(ChangesWith(clouds, write("clouds/frames.csv")));
  EXPECT_TRUE(ChangesWith(clouds / "0.pcd", clouds / "0.pcd"));
  const fs::path capture = write("drive.pcap");
  EXPECT_TRUE(ChangesWith(capture, capture));
  EXPECT_TRUE(ChangesWith(capture, write("drive.dat")));
  const fs::path velodyne = write("sequences/00/velodyne/0.bin").parent_path();
  EXPECT_TRUE(ChangesWith(velodyne, velodyne / "0.bin"));
  EXPECT_TRUE(ChangesWith(velodyne, write("sequences/00/labels/0.label")));
  EXPECT_TRUE(ChangesWith(velodyne, write("sequences/00/poses.txt")));
  EXPECT_TRUE(ChangesWith(velodyne / "0.bin", velodyne / "../labels/0.label"));
  EXPECT_FALSE(ChangesWith(clouds, capture));
}

TEST(RecordingTraits, OfASequenceAreItsManifest) {
  const TemporaryDirectory folder;
  const fs::path run = folder.path() / "run";
  fs::create_directories(run);
  for (const char* const name : {"frames.jsonl", "manifest.json"}) {
    WriteFileWhole(run / name, "content");
  }
  EXPECT_TRUE(ChangesWith(run, run / "manifest.json"));
  // Frames are compared with the hashes that it covers where they are read.
  EXPECT_FALSE(ChangesWith(run, run / "frames.jsonl"));
  fs::remove(run / "manifest.json");
  EXPECT_TRUE(ChangesWith(run, run / "frames.jsonl"));
}

/// A plan of a box 1 m wide and high, 20 m ahead of a VLP-16 that stands 1 m above the rails, and a
/// second one behind the first.
struct CheckedPlan {
  explicit CheckedPlan(const std::vector<std::string>& points) {
    const auto source = WriteReceived(folder.path() / "run", StraightRun(4, 0.0), points);
    const std::string box = R"("type": "box", "size_m": [1, 1, 1], "d_m": 0, "h_m": 2, )";
    const auto file = WritePlan(folder.path(), "{}",
                                R"(, "objects": [{"name": "near", )" + box +
                                    R"("s_m": 20.5}, {"name": "far", )" + box + R"("s_m": 900}])",
                                VelodyneOfPlan());
    plan = ReadInsertPlan(file, source);
    check = CheckPlan(plan, source, {0, static_cast<std::uint32_t>(plan.frame_times_ns.size())},
                      {OpenRecording(source)->info(), plan.scenario.lidar.scan, true});
  }

  TemporaryDirectory folder;
  InsertPlan plan;
  PlanCheck check;
};

TEST(PlanCheck, CountsTheFiringsThatAimAtAThing) {
  const CheckedPlan checked({"5 5 0"});
  ASSERT_EQ(checked.check.things.size(), 2U);
  const ThingCheck& near = checked.check.things[0];
  EXPECT_EQ(near.num_frames_in_reach, 4U);
  // The face is 1 m wide at 20 m, from 0.5 m below the sensor to 0.5 m above it: the rows at -1 and
  // 1 deg in 2.864 deg of azimuth, of which there are 1808 steps.
  EXPECT_NEAR(static_cast<double>(near.most_firings), 2.0 * 2.864 / 360.0 * 1808.0, 4.0);
  EXPECT_EQ(near.num_points, 0U);
  EXPECT_EQ(checked.check.things[1].num_frames_in_reach, 0U);
}

TEST(PlanCheck, SaysWhatWasRecordedWhereAThingShallBe) {
  // Two points before the box, one inside it, one behind it, one in the ground below its foot.
  const CheckedPlan checked({"10 0 0", "19 0 0.1", "20.3 0.1 0", "40 0 0", "20.5 0 -0.45"});
  const ThingCheck& near = checked.check.things[0];
  EXPECT_EQ(near.num_points, 4U * 5U);
  EXPECT_EQ(near.num_points_before, 4U * 2U);
  EXPECT_EQ(near.num_points_inside, 4U * 1U);
  EXPECT_EQ(near.num_frames_inside, 4U);
  const std::string text = PlanCheckText(checked.plan, checked.check);
  EXPECT_EQ(text.substr(0, text.find("  aimed")),
            "near:\n  at chainage 20.5 m, 0 m left, 2 m above the rails (asked: s_m 20.5, d_m 0, "
            "h_m 2)\n");
  EXPECT_NE(
      text.find("; of 20 recorded points in its direction 40 % are before it, 20 % inside it, "
                "in 4 of 4 frames: a recorded surface stands there\n"),
      text.npos)
      << text;
  EXPECT_NE(text.find("\n  no firing aims at it in any of the 4 frames\n"), text.npos) << text;
}

}  // namespace
}  // namespace railcast
