#include "generator/extras/insert/plan/pose_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "core/io/write_file.h"
#include "generator/extras/insert/plan/recorded_way.h"
#include "railcast/remark.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/temporary_directory.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;

/// Turned a quarter to the left, 100 m east and 7 m up; then 2 m further north.
constexpr const char* kKittiLines = "0 -1 0 100 1 0 0 20 0 0 1 7\n0 -1 0 100 1 0 0 22 0 0 1 7\n";
constexpr const char* kCsv =
    "stamp_ns,x,y,z,qx,qy,qz,qw\n"
    "1000000000,100,20,7,0,0,0.7071067811865476,0.7071067811865476\n"
    "1100000000,100,22,7,0,0,0.7071067811865476,0.7071067811865476\n";

/// The lidar is 2 m above the vehicle; frames stand in the order of texts, and one says its
/// transform the other way round.
std::string OpenLabelOf(const std::string& second_transform) {
  return R"({"openlabel": {"metadata": {"schema_version": "1.0.0"},
    "coordinate_systems": {
      "world": {"type": "scene_cs", "parent": "", "children": ["base"]},
      "base": {"type": "local", "parent": "world", "children": ["lidar"]},
      "lidar": {"type": "sensor", "parent": "base",
                "pose_wrt_parent": {"translation": [0, 0, 2], "quaternion": [0, 0, 0, 1]}}},
    "frames": {
      "10": {"frame_properties": {"timestamp": 1.1, "transforms": {)" +
         second_transform + R"(}}},
      "9": {"frame_properties": {"timestamp": "1.0", "transforms": {"base_to_world":
        {"src": "base", "dst": "world", "transform_src_to_dst":
          {"matrix4x4": [0, -1, 0, 100, 1, 0, 0, 20, 0, 0, 1, 5, 0, 0, 0, 1]}}}}}}}})";
}
constexpr const char* kWorldToBase =
    R"("world_to_base": {"src": "world", "dst": "base", "transform_src_to_dst":
       {"translation": [-22, 100, -5], "quaternion": [0, 0, -0.7071067811865476,
        0.7071067811865476]}})";

PoseFile ReadText(const std::string& name, const std::string& text) {
  const TemporaryDirectory folder;
  WriteFileWhole(folder.path() / name, text);
  return ReadPoseFile(folder.path() / name, "lidar");
}

std::string FaultOf(const std::string& name, const std::string& text) {
  const TemporaryDirectory folder;
  WriteFileWhole(folder.path() / name, text);
  const std::string said = MessageOf([&] { (void)ReadPoseFile(folder.path() / name, "lidar"); });
  return said.substr(std::min(said.size(), folder.path().string().size() + 1));
}

TEST(PoseFile, SaysTheSameInEachFormat) {
  const PoseFile kitti = ReadText("poses.txt", kKittiLines);
  const PoseFile csv = ReadText("poses.csv", kCsv);
  const PoseFile label = ReadText("poses.json", OpenLabelOf(kWorldToBase));
  ASSERT_EQ(kitti.world_from_sensor.size(), 2U);
  EXPECT_TRUE(kitti.world_from_sensor[1].translation().isApprox(Vector3(100.0, 22.0, 7.0)));
  EXPECT_TRUE(kitti.stamps_ns.empty());
  for (const PoseFile* const other : {&csv, &label}) {
    ASSERT_EQ(other->world_from_sensor.size(), 2U);
    EXPECT_THAT(other->stamps_ns, ElementsAre(1'000'000'000, 1'100'000'000));
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_TRUE(other->world_from_sensor[i].isApprox(kitti.world_from_sensor[i], 1e-9)) << i;
    }
  }
}

TEST(PoseFile, ReadsTheLinesOfTum) {
  const PoseFile tum = ReadText("poses.tum",
                                "# timestamp tx ty tz qx qy qz qw\n"
                                "1700000000.000000001 100 20 7 0 0 0.7071067811865476 "
                                "0.7071067811865476\n1.7000000001e9 100 22 7 0 0 0 1\n\n");
  EXPECT_THAT(tum.stamps_ns, ElementsAre(1'700'000'000'000'000'001, 1'700'000'000'100'000'000));
  ASSERT_EQ(tum.world_from_sensor.size(), 2U);
  const PoseFile kitti = ReadText("poses.txt", kKittiLines);
  EXPECT_TRUE(tum.world_from_sensor[0].isApprox(kitti.world_from_sensor[0], 1e-9));
  EXPECT_EQ(FaultOf("a.txt", "0 0 0 0 0 0 0 1\n1 2 3\n"),
            "a.txt:2: must be the 8 numbers of a time and a pose, as in TUM's format");
}

// A quaternion of zeros is no rotation, in any format and wherever it stands.
TEST(PoseFile, MustHaveQuaternionsOfLength1) {
  const std::string label = OpenLabelOf(kWorldToBase);
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = label;
    return text.replace(text.find(from), from.size(), to);
  };
  for (const auto& [turn, length] : std::vector<std::pair<std::string, std::string>>{
           {"0, 0, 0, 0", "0"}, {"0, 0, 0, 0.9", "0.9"}, {"0, 0, 3, 4", "5"}}) {
    std::string words = turn;
    std::erase(words, ',');
    std::string commas = turn;
    std::erase(commas, ' ');
    const std::string rule = ": a quaternion must have length 1 (got " + length + ")";
    EXPECT_EQ(FaultOf("a.tum", "0 0 0 0 0 0 0 1\n0.1 0 0 0 " + words + "\n"), "a.tum:2" + rule);
    EXPECT_EQ(FaultOf("a.csv", "stamp_ns,x,y,z,qx,qy,qz,qw\n0,0,0,0," + commas + "\n"),
              "a.csv:2" + rule);
    EXPECT_EQ(FaultOf("a.json", with("[0, 0, 0, 1]", "[" + turn + "]")),
              "a.json: /openlabel/coordinate_systems/lidar/pose_wrt_parent" + rule);
    EXPECT_EQ(FaultOf("a.json", with("[0, 0, -0.7071067811865476,\n        0.7071067811865476]",
                                     "[" + turn + "]")),
              "a.json: /openlabel/frames/10/frame_properties/transforms/world_to_base/"
              "transform_src_to_dst" +
                  rule);
  }
}

TEST(PoseFile, MayHaveAByteOrderMarkOrBeUtf16) {
  EXPECT_EQ(ReadText("poses.csv", "\xEF\xBB\xBF" + std::string(kCsv) + "\r\n").stamps_ns.size(),
            2U);
  std::string utf16 = "\xFF\xFE";
  for (const char letter : std::string(kKittiLines)) utf16 += {letter, '\0'};
  EXPECT_EQ(ReadText("poses.txt", utf16).world_from_sensor.size(), 2U);
}

TEST(PoseFile, NamesTheUnitThatItsTimesHave) {
  const auto csv = [](const std::string& second_stamp, const std::string& second_x) {
    return "stamp_ns,x,y,z,qx,qy,qz,qw\n0,100,0,0,0,0,0,1\n" + second_stamp + "," + second_x +
           ",0,0,0,0,0,1\n";
  };
  const std::string rule = "a.csv: times: must be 0.01 to 10 s apart in the median (got ";
  EXPECT_EQ(FaultOf("a.csv", csv("100000", "100.9")), rule + "0.0001 s): are they microseconds?");
  EXPECT_EQ(FaultOf("a.csv", csv("100", "100.9")), rule + "1e-07 s): are they milliseconds?");
  EXPECT_EQ(FaultOf("a.csv", csv("30000000000", "100.9")), rule + "30 s): are they milliseconds?");
  EXPECT_EQ(FaultOf("a.txt", "0 0 0 0 0 0 0 1\n100 0 0 0 0 0 0 1\n"),
            "a.txt: times: must be 0.01 to 10 s apart in the median (got 100 s): are they "
            "milliseconds?");
  EXPECT_EQ(FaultOf("a.csv", csv("100000000", "120")),
            "a.csv: poses: must not be faster than 150 m/s over the whole way (got 20 m in 0.1 s)");
}

TEST(PoseFile, MustHaveTimesThatRise) {
  EXPECT_EQ(FaultOf("a.txt",
                    "0 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n"
                    "2 0 0 0 0 0 0 1\n"),
            "a.txt: times: each must be after the one before it (got 0 s after it)");
}

TEST(PoseFile, MayBeOfStationsThatAreMinutesApart) {
  const TemporaryDirectory folder;
  const fs::path file = folder.path() / "a.txt";
  const auto read = [&](const std::string& second_time) {
    WriteFileWhole(file, "0 0 0 0 0 0 0 1\n" + second_time + " 0.9 0 0 0 0 0 1\n");
    return ReadPoseFile(file, "lidar", std::numeric_limits<double>::infinity());
  };
  EXPECT_EQ(read("300").step_ns, 300'000'000'000);
  EXPECT_EQ(MessageOf([&] { (void)read("0.0001"); }),
            file.string() +
                ": times: must be at least 0.01 s apart in the median (got 0.0001 s): are they "
                "microseconds?");
}

TEST(PoseFile, MustHaveTheTimesOfTheFramesSinceTheFirst) {
  const PoseFile csv = ReadText("poses.csv", kCsv);
  std::vector<Remark> remarks;
  SetRemarkReceiver([&](const Remark& remark) { remarks.push_back(remark); });
  CheckFrameStamps(csv, {{0, 0}, {1, 0}}, "a.csv");  // The frames have no times.
  CheckFrameStamps(csv, {{0, 1'000'000'000}, {1, 1'150'000'000}}, "a.csv");
  EXPECT_THAT(remarks, testing::IsEmpty());
  CheckFrameStamps(csv, {{0, 100'000'000'000}, {1, 100'100'000'000}}, "a.csv");
  EXPECT_THAT(remarks, ElementsAre(Remark{RemarkKind::kTimesRelative, "a.csv", 2}));
  SetRemarkReceiver(nullptr);
  EXPECT_EQ(MessageOf([&] {
              CheckFrameStamps(csv, {{0, 0}, {1, 151'000'000}}, "a.csv");
            }),
            "a.csv: times: must be as long after the first as those of the frames (got 0.1 s for "
            "frame 1, which came after 0.151 s)");
}

TEST(KittiPoses, AreLeftOutWithARemarkWithoutTheCalibrationOfTheSensor) {
  const TemporaryDirectory folder;
  WriteFileWhole(folder.path() / "poses.txt", kKittiLines);
  std::vector<Remark> remarks;
  SetRemarkReceiver([&](const Remark& remark) { remarks.push_back(remark); });
  EXPECT_THAT(ReadKittiPoses(folder.path(), 2).world_from_sensor, testing::IsEmpty());
  SetRemarkReceiver(nullptr);
  ASSERT_EQ(remarks.size(), 1U);
  EXPECT_EQ(remarks[0].Text(),
            "1 file left out: calib.txt beside it must have Tr, the sensor's "
            "pose in the axes of camera 0 (in " +
                (folder.path() / "poses.txt").string() + ")");
}

TEST(PoseFile, MustHaveAxesOfWhichZIsUp) {
  EXPECT_EQ(FaultOf("a.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0 0 1 0 0.1 0 0 1 8\n"),
            "a.txt: poses: must not climb more than 1 m in 2 m (got 8 m in 8.001 m): are the axes "
            "those of a camera?");
  std::vector<Remark> remarks;
  SetRemarkReceiver([&](const Remark& remark) { remarks.push_back(remark); });
  (void)ReadText("a.tum", "0 0 0 0 0 0 0 1\n0.1 1 0 4 0 0 0 1\n");  // A step of noise.
  EXPECT_THAT(remarks, testing::IsEmpty());
  (void)ReadText("a.tum", "0 0 0 0 1 0 0 0\n0.1 1 0 0 1 0 0 0\n");
  SetRemarkReceiver(nullptr);
  ASSERT_EQ(remarks.size(), 1U);
  EXPECT_EQ(remarks[0].kind, RemarkKind::kPosesOverturned);
  EXPECT_EQ(remarks[0].number, 2U);
}

TEST(PoseFile, SaysWhatIsWrong) {
  EXPECT_EQ(FaultOf("a.txt", "1 0 0 0 0 1 0 0 0 0 2 0\n"),
            "a.txt:1: must be the 12 numbers of a pose");
  EXPECT_EQ(FaultOf("a.txt", "1700000000.0,0,0,2,0,0,0,1\n"),
            "a.txt:1: numbers must be separated by blanks");
  EXPECT_EQ(FaultOf("a.csv", "t,x\n"), "a.csv:1: must be stamp_ns,x,y,z,qx,qy,qz,qw (got t,x)");
  EXPECT_EQ(FaultOf("a.csv", "stamp_ns,x,y,z,qx,qy,qz,qw\nnow,0,0,0,0,0,0,1\n"),
            "a.csv:2: stamp_ns: must be a whole number of at most 4.5e18 (got now)");
  EXPECT_EQ(FaultOf("a.csv", "stamp_ns,x,y,z,qx,qy,qz,qw\n-9223372036854775808,0,0,0,0,0,0,1\n"),
            "a.csv:2: stamp_ns: must be a whole number of at most 4.5e18 (got "
            "-9223372036854775808)");
  EXPECT_EQ(FaultOf("a.json", "{"), "a.json: must be a file of OpenLABEL");
  EXPECT_EQ(FaultOf("a.json", "{}"), "a.json: /openlabel: missing");
  EXPECT_EQ(FaultOf("a.json", OpenLabelOf("")),
            "a.json: /openlabel/frames/10/frame_properties/transforms: must lead from \"lidar\" "
            "to the world");
  EXPECT_NE(FaultOf("a.json", OpenLabelOf(
                                  R"("a": {"src": "base", "dst": "world", "transform_src_to_dst":
                                     {"matrix4x4": [1, 1, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]}})"))
                .find("transform_src_to_dst: must be a rotation and a translation"),
            std::string::npos);
  EXPECT_EQ(FaultOf("a.json", R"({"openlabel": {"coordinate_systems": {"base": {}}}})"),
            "a.json: /openlabel/coordinate_systems: must have that of the sensor \"lidar\"");
}

TEST(PoseFile, OfOsdarSaysThatItsFramesHaveNoPlace) {
  const fs::path file =
      fs::path(RAILCAST_SHARED_DATA_DIR) / "osdar23_openlabel/1_calibration_1.1_labels.json";
  if (!exists(file)) GTEST_SKIP() << file << " is not there";
  EXPECT_EQ(MessageOf([&] { (void)ReadPoseFile(file, "lidar"); }),
            file.string() +
                ": /openlabel/frames/12/frame_properties/transforms: must lead from \"lidar\" to "
                "the world");
}

TEST(PoseFile, GivesCloudsWithoutPosesTheirWay) {
  const TemporaryDirectory folder;
  fs::create_directories(folder.path() / "clouds");
  for (const char* const name : {"a.pcd", "b.pcd"}) {
    WriteFileWhole(folder.path() / "clouds" / name,
                   "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 1\nHEIGHT 1\n"
                   "POINTS 1\nDATA ascii\n5 0 -1\n");
  }
  const fs::path file = folder.path() / "poses.csv";
  WriteFileWhole(file, kCsv);
  LidarSpec lidar;
  lidar.mount.position_m = {0.0, 0.0, 2.0};
  RecordingWorldSpec world{.poses_file = file.string()};
  std::vector<std::string> remarks;
  const auto read = [&] {
    return ReadRecordedWay(folder.path() / "clouds", world, lidar, remarks);
  };
  const RecordedWay way = read();
  EXPECT_THAT(way.frame_times_ns, ElementsAre(0, 100'000'000));
  EXPECT_EQ(way.first_stamp_ns, 1'000'000'000);
  EXPECT_TRUE(way.at_frames[1].translation().isApprox(Vector3(100.0, 22.0, 5.0)));
  WriteFileWhole(folder.path() / "clouds/c.pcd", ReadFileWhole(folder.path() / "clouds/a.pcd"));
  EXPECT_EQ(MessageOf([&] { (void)read(); }),
            file.string() + ": must have a pose for each of the 3 frames (got 2)");
  fs::remove(folder.path() / "clouds/c.pcd");
  fs::rename(folder.path() / "clouds/a.pcd", folder.path() / "clouds/1.0.pcd");
  fs::rename(folder.path() / "clouds/b.pcd", folder.path() / "clouds/1.3.pcd");
  EXPECT_EQ(MessageOf([&] { (void)read(); }),
            file.string() +
                ": times: must be as long after the first as those of the frames (got 0.1 s for "
                "frame 1, which came after 0.3 s)");
}

}  // namespace
}  // namespace railcast
