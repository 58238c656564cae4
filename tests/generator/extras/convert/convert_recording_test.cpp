#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/extras/insert/insertion_verification.h"
#include "core/extras/packets/pcap/pcap_writer.h"
#include "core/io/cloud/cloud_file.h"
#include "core/io/run/table_records.h"
#include "core/io/write_file.h"
#include "core/scenario/sensors.h"
#include "generator/extras/insert/plan/pose_file.h"
#include "tests/core/extras/packets/velodyne/made_scan.h"
#include "tests/core/extras/ros/recording/made_bag.h"
#include "tests/core/io/cloud/made_las.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/extras/convert/converted.h"
#include "tests/generator/extras/insert/run/made_insertion.h"
#include "tests/support/exits_with.h"
#include "tests/support/sensor_file.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

/// Recordings of each kind that are no sequences.
class ConvertRecording : public testing::Test {
 protected:
  [[nodiscard]] fs::path Path(const std::string& name) const { return folder_.path() / name; }

  /// Two clouds of others: fields of all types, one in double precision, times, a missing point.
  [[nodiscard]] fs::path MakeClouds() const {
    const std::string header =
        "VERSION 0.7\nFIELDS x y z intensity t curvature gps_time class_id echo_id offset\n"
        "SIZE 4 4 4 4 4 4 8 1 2 4\nTYPE F F F F U F F U U I\nWIDTH 3\nHEIGHT 1\nPOINTS 3\n"
        "DATA ascii\n";
    fs::create_directories(Path("clouds"));
    for (const std::string name : {"1700000000.05.pcd", "1700000000.15.pcd"}) {
      WriteFileWhole(Path("clouds") / name,
                     header + "1.5 2 0.1 0.25 0 0.5 1700000000.0123456 7 65535 -3\n" +
                         "nan nan nan 0 40000000 nan 1700000000.05 0 0 2147483647\n" +
                         "-1 2 0.3 1e-7 90000000 -0.5 1700000000.1 255 1 -2147483648\n");
    }
    return Path("clouds");
  }
  [[nodiscard]] fs::path MakeDriveCapture() const {
    const MadeScan scan(ReadSensor("vlp16"));
    std::vector<Frame> frames;
    for (std::uint32_t i = 0; i < 4; ++i) frames.push_back(scan.MakeFrame(i, 2));
    const Datagrams datagrams = EncodeAll("vlp16-dual", scan, frames);
    PcapWriter writer(Path("drive.pcap"), kVelodyneDataPort, kVelodynePositionPort);
    writer.Write(datagrams, datagrams.items);
    writer.Finish();
    return Path("drive.pcap");
  }
  [[nodiscard]] fs::path MakeRun(const std::string& format) const {
    MadeSequenceSpec made{.format = format, .num_frames = 3};
    made.return_mode = "dual";
    (void)MakeSequence(Path("run_" + format), made);
    return Path("run_" + format);
  }

  const TemporaryDirectory folder_;
};

std::vector<std::string> AllFormats() {
  return ConvertFormats();
}

TEST_F(ConvertRecording, KeepsOutOfTheSequenceOfItsClouds) {
  fs::create_directories(Path("run/frames"));
  for (const char* const name : {"run/frames.jsonl", "run/run.json"}) {
    WriteFileWhole(Path(name), "");
  }
  EXPECT_THAT(RunCommand(RAILCAST_GENERATE " convert " + Path("run/frames").string() + " " +
                         Path("run/out").string()),
              ExitsWith(1, testing::StartsWith("OUT: must be outside ")));
}

TEST_F(ConvertRecording, KeepsEveryNumberOfCloudsOfOthersWhateverTheFormat) {
  const fs::path clouds = MakeClouds();
  std::vector<RecordedFrame> expected = ReadAll(clouds);
  std::vector<Cloud> stored;
  for (const char* name : {"1700000000.05.pcd", "1700000000.15.pcd"}) {
    stored.push_back(ReadCloud(clouds / name));
  }
  for (const std::string format : {"pcd", "pcd-compressed", "pcd-ascii", "mcap", "rosbag2"}) {
    const fs::path out = ConvertTo(format, clouds, Path(format));
    ExpectSameFrames(ReadAll(out), expected);
    const fs::path back = ConvertTo("pcd", out, Path(format + "_back"));
    ExpectSameFrames(ReadAll(back), expected);
    for (std::size_t i = 0; i < stored.size(); ++i) {
      const Cloud cloud = ReadCloud(back / ("frames/00000" + std::to_string(i) + ".pcd"));
      EXPECT_EQ(cloud.data, stored[i].data) << format;
    }
  }
}

TEST_F(ConvertRecording, LeavesOutOfPlyOnlyWhatHasNoPosition) {
  const fs::path clouds = MakeClouds();
  const Cloud stored = ReadCloud(clouds / "1700000000.05.pcd");
  for (const std::string format : {"ply", "ply-cloudcompare"}) {
    const ConvertResult result =
        ConvertAll({.recording = clouds, .directory = Path(format), .format = format});
    EXPECT_EQ(result.lost, (Losses{{"places without a point", 2}}));
    (void)ConvertTo("pcd", Path(format), Path(format + "_back"));
    const Cloud cloud = ReadCloud(Path(format + "_back") / "frames/000000.pcd");
    ASSERT_EQ(cloud.num_points(), 2U);
    for (const CloudField& field : stored.fields) {
      const CloudField* const found = cloud.Find(field.name);
      ASSERT_NE(found, nullptr) << field.name;
      const auto value_of = [](const Cloud& of, const CloudField& column, std::size_t point) {
        double value = 0.0;
        VisitField(of, column, [&](std::size_t i, auto each) {
          if (i == point) value = static_cast<double>(each);
        });
        return value;
      };
      EXPECT_EQ(value_of(cloud, *found, 0), value_of(stored, field, 0)) << field.name;
      EXPECT_EQ(value_of(cloud, *found, 1), value_of(stored, field, 2)) << field.name;
    }
  }
}

TEST_F(ConvertRecording, SaysWhatKittiHasNoPlaceFor) {
  const ConvertResult result =
      ConvertAll({.recording = MakeClouds(), .directory = Path("kitti"), .format = "kitti"});
  EXPECT_EQ(result.lost, (Losses{{"places without a point", 2},
                                 {"stamps of the first frame, from which the others count", 1},
                                 {"values of echo_id", 4},
                                 {"values of class_id", 4},
                                 {"values of curvature", 4},
                                 {"values of gps_time", 4},
                                 {"values of offset", 4},
                                 {"values of time_ns", 4}}));
  const auto frames = ReadAll(Path("kitti"));
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[0].frame.intensity[1], 1e-7F);
  EXPECT_EQ(ReadFileWhole(Path("kitti/sequences/00/times.txt")), "0\n0.1\n");
  EXPECT_FALSE(fs::exists(Path("kitti/sequences/00/poses.txt")));
}

TEST_F(ConvertRecording, KeepsCapturesWithTheirSlots) {
  const fs::path capture = MakeDriveCapture();
  const std::vector<RecordedFrame> expected = ReadAll(capture);
  for (const std::string format : {"pcd", "mcap"}) {
    ExpectSameFrames(ReadAll(ConvertTo(format, capture, Path(format))), expected);
  }
}

TEST_F(ConvertRecording, KeepsPosesAndPointsOfSequencesInBags) {
  const fs::path run = MakeRun("pcd");
  const std::vector<RecordedFrame> expected = ReadAll(run);
  for (const std::string format : {"mcap", "rosbag2"}) {
    const fs::path bag = ConvertTo(format, run, Path(format));
    ExpectSameFrames(ReadAll(bag), expected);
    ExpectSameMotion(ReadAll(bag), expected);
    ExpectSameFrames(ReadAll(ConvertTo("pcd", bag, Path(format + "_back"))), expected);
  }
}

TEST_F(ConvertRecording, KeepsStampsAndPosesOfForeignBags) {
  MadeBag made;
  for (int i = 0; i < 3; ++i) {
    made.Add("/points", i * kSecond_ns, CloudOf(kBagPoints, i * kSecond_ns + kSecond_ns / 2));
    made.Link("/tf", "map", "lidar", i * kSecond_ns, {{1.0 * i, 2.0, 3.0}, {0.0, 0.0, 0.6, 0.8}});
  }
  made.Commit();
  const fs::path bag = made.Closed();
  const std::vector<RecordedFrame> expected = ReadAll(bag);
  ASSERT_TRUE(expected[0].has_pose);
  ASSERT_FALSE(expected[2].has_pose);
  for (const std::string format : {"pcd", "rosbag2"}) {
    ExpectSameFrames(ReadAll(ConvertTo(format, bag, Path(format))), expected);
  }
  const auto back = bag::OpenBag(Path("rosbag2/rosbag2"));
  EXPECT_NE(std::ranges::find(back->topics(), "/points", &bag::BagTopic::name),
            back->topics().end());
  // The last frame has no pose.
  const ConvertResult kitti =
      ConvertAll({.recording = bag, .directory = Path("kitti"), .format = "kitti"});
  EXPECT_EQ(kitti.lost.at("poses, which not all frames have"), 2U);
  EXPECT_FALSE(fs::exists(Path("kitti/sequences/00/poses.txt")));
  EXPECT_EQ(ReadFileWhole(Path("kitti/sequences/00/times.txt")), "0\n1\n2\n");
}

/// The text of a cloud of two points in two rows.
std::string RowsOf(const std::string& fields, const std::string& size, const std::string& type) {
  return "VERSION 0.7\nFIELDS " + fields + "\nSIZE " + size + "\nTYPE " + type +
         "\nWIDTH 1\nHEIGHT 2\nVIEWPOINT 1 0 0 1 0 0 0\nPOINTS 2\nDATA ascii\n" +
         "1 2 3 4\n5 6 7 8\n";
}

TEST_F(ConvertRecording, CountsRowsAndViewpointsOfClouds) {
  WriteFileWhole(Path("rows.pcd"), RowsOf("X Y Z intensity", "4 4 4 4", "F F F F"));
  const Losses viewpoint = {{"viewpoints other than the origin", 1}};
  const Losses both = {{"rows of organised clouds", 2}, {"viewpoints other than the origin", 1}};
  for (const std::string format : {"pcd", "mcap", "ply", "ply-cloudcompare", "kitti"}) {
    const ConvertResult result =
        ConvertAll({.recording = Path("rows.pcd"), .directory = Path(format), .format = format});
    EXPECT_EQ(result.lost, format == "pcd" || format == "mcap" ? viewpoint : both) << format;
    const bool is_mcap = format == "mcap";
    const auto frames = ReadAll(is_mcap ? Path("mcap/frames.mcap") : Path(format));
    EXPECT_THAT(frames.at(0).frame.x, testing::UnorderedElementsAre(1.0F, 5.0F)) << format;
  }
  EXPECT_FALSE(fs::exists(Path("kitti/sequences/00/times.txt")));
}

TEST_F(ConvertRecording, RefusesPositionsThatTheFormatCannotHold) {
  WriteFileWhole(Path("two.pcd"),
                 "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 2 1 1\n"
                 "WIDTH 1\nHEIGHT 1\nPOINTS 1\nDATA ascii\n1 2 3 4\n");
  EXPECT_THAT(
      MessageOf([&] { (void)ConvertTo("ply", Path("two.pcd"), Path("ply")); }),
      testing::EndsWith("two.pcd: x: must be a number of a type that ply has (got 2 of F4)"));
}

TEST_F(ConvertRecording, LeavesOutFieldsThatFilesCannotName) {
  ros::PointCloud2 cloud = CloudOf(kBagPoints, 0);
  cloud.fields.push_back({"a b", 0, 2, 1});
  cloud.fields.push_back({"", 13, 2, 1});
  cloud.fields.push_back({"scalar_ring", 14, 2, 1});
  MadeBag made;
  made.Add("/points", 0, cloud);
  made.Commit();
  const fs::path bag = made.Closed();
  for (const std::string format : {"pcd", "ply"}) {
    const ConvertResult result =
        ConvertAll({.recording = bag, .directory = Path(format), .format = format});
    EXPECT_EQ(result.lost.at("values of a b"), 4U);
    EXPECT_EQ(result.lost.at("values of "), 4U);
    EXPECT_EQ(result.lost.at("values of ring"), 4U);
    EXPECT_EQ(ReadAll(Path(format)).size(), 1U);
  }
}

TEST_F(ConvertRecording, TellsWhatOfAReceivedStreamIsLost) {
  fs::create_directories(Path("stream"));
  fs::copy(MakeClouds(), Path("stream/frames"), fs::copy_options::recursive);
  const std::string pose = ",0,0,0,0,0,0,1,";
  WriteFileWhole(Path("stream/frames.csv"),
                 "file,run,frame,stamp_ns,x,y,z,qx,qy,qz,qw,points,lost_points\n"
                 "frames/1700000000.05.pcd,3,17,50" +
                     pose +
                     "3,9\n"
                     "frames/1700000000.15.pcd,3,18,150" +
                     pose + "3,0\n");
  const ConvertResult result =
      ConvertAll({.recording = Path("stream"), .directory = Path("out"), .format = "pcd"});
  EXPECT_EQ(result.lost, (Losses{{"runs, lost points and times of arrival", 2}}));
  EXPECT_EQ(ReadAll(Path("out")).at(1).frame.index, 18U);
  EXPECT_EQ(
      ConvertAll({.recording = Path("out"), .directory = Path("again"), .format = "pcd"}).lost,
      Losses());
}

TEST_F(ConvertRecording, GivesLabelsOfNoTableTheNumber0InKitti) {
  const fs::path run = MakeRun("pcd");
  const fs::path out = ConvertTo("pcd", ConvertTo("mcap", run, Path("bag")), Path("out"));
  std::vector<Label> labels(1);
  labels[0].name = "none";
  WriteFileWhole(out / "labels.json", LabelsJson(LabelTable(labels)));
  std::uint64_t num = 0;
  for (const RecordedFrame& frame : ReadAll(out)) {
    for (std::size_t slot = 0; slot < frame.frame.num_slots(); ++slot) {
      num += frame.frame.label[slot] == 0 || std::isnan(frame.frame.x[slot]) ? 0 : 1;
    }
  }
  const ConvertResult result =
      ConvertAll({.recording = out, .directory = Path("kitti"), .format = "kitti"});
  EXPECT_EQ(result.lost.at("labels without a number in SemanticKITTI, now 0"), num);
}

TEST_F(ConvertRecording, GivesKittisFilesBackByWayOfOthers) {
  const fs::path run = MakeRun("kitti");
  fs::create_directories(Path("others"));
  fs::copy(run / "sequences", Path("others/sequences"), fs::copy_options::recursive);
  for (const std::string format : {"pcd-ascii", "ply", "mcap"}) {
    const fs::path out = ConvertTo(format, Path("others"), Path(format));
    (void)ConvertTo("kitti", out, Path(format + "_back"));
    for (const char* name : {"velodyne/000001.bin", "labels/000001.label"}) {
      EXPECT_EQ(ReadFileWhole(Path(format + "_back") / "sequences/00" / name),
                ReadFileWhole(run / "sequences/00" / name))
          << format << name;
    }
    const auto poses_of = [](const fs::path& folder) {
      return ReadKittiPoses(folder / "sequences/00/velodyne", 3).world_from_sensor;
    };
    const auto poses = poses_of(Path(format + "_back"));
    ASSERT_EQ(poses.size(), 3U);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_TRUE(poses[i].isApprox(poses_of(run)[i], 1e-12));  // Quaternions round.
    }
    EXPECT_EQ(ReadFileWhole(Path(format + "_back") / "sequences/00/times.txt"),
              ReadFileWhole(run / "sequences/00/times.txt"));
  }
}

TEST_F(ConvertRecording, KeepsPositionsAndClassesOfLas) {
  WriteFileWhole(Path("site.las"), MadeLas{.format = 1}.Bytes(3));
  const std::vector<RecordedFrame> expected = ReadAll(Path("site.las"));
  for (const std::string format : {"pcd", "ply", "mcap"}) {
    const fs::path out = ConvertTo(format, Path("site.las"), Path(format));
    ExpectSameFrames(ReadAll(out), expected);
    const auto labels = OpenRecording(out)->info().labels;
    EXPECT_EQ(labels.labels().empty(), format == "mcap");
  }
  EXPECT_THAT(MessageOf([&] { (void)ConvertTo("kitti", Path("site.las"), Path("kitti")); }),
              testing::EndsWith("must have positions near 0 for --format kitti, which are float32 "
                                "(got those of a national grid); pcd, ply, mcap and rosbag2 keep "
                                "them"));
  EXPECT_FALSE(fs::exists(Path("kitti")));
}

TEST_F(ConvertRecording, GivesTheSameBytesHoweverItIsMade) {
  const fs::path run = MakeRun("pcd");
  fs::create_directories(Path("clouds"));
  fs::copy(run / "frames", Path("clouds"));
  for (const std::string& format : AllFormats()) {
    for (const int num_threads : {1, 4}) {
      EXPECT_TRUE(ConvertAll({.recording = Path("clouds"),
                              .directory = Path(format + std::to_string(num_threads)),
                              .format = format,
                              .num_threads = num_threads})
                      .is_complete);
    }
    const ConvertChoices stopped = {
        .recording = Path("clouds"), .directory = Path(format + "_stopped"), .format = format};
    EXPECT_FALSE(ConvertAll(stopped, 2).is_complete);
    const ConvertResult result = ConvertAll(stopped);
    EXPECT_EQ(result.num_resumed, 2U) << format;
    const auto whole = FilesOf(Path(format + "1"));
    EXPECT_TRUE(FilesOf(Path(format + "4")) == whole) << format;
    EXPECT_TRUE(FilesOf(Path(format + "_stopped")) == whole) << format;
    EXPECT_THAT(VerifyInsertion(stopped.directory, [](double) {}).faults, testing::IsEmpty());
    EXPECT_TRUE(ConvertAll(stopped).was_complete);
  }
}

TEST_F(ConvertRecording, MakesWhatWasChangedAnew) {
  const fs::path clouds = MakeClouds();
  for (const std::string format : {"ply", "mcap"}) {
    const fs::path out = Path(format);
    (void)ConvertTo(format, clouds, out);
    const auto whole = FilesOf(out);
    const fs::path changed = out / (format == "ply" ? "frames/000001.ply" : "frames.mcap");
    WriteFileWhole(changed, ReadFileWhole(changed) + "x");
    EXPECT_THAT(VerifyInsertion(out, [](double) {}).faults, testing::SizeIs(1));
    EXPECT_THAT(ConvertAll({.recording = clouds, .directory = out, .format = format}).changed,
                testing::SizeIs(1));
    EXPECT_TRUE(FilesOf(out) == whole) << format;
  }
}

// What is left of a bag that was interrupted: nothing, no bytes, a part, or others.
TEST_F(ConvertRecording, BeginsABagAnewOfWhichNotAllCanBeRead) {
  const fs::path run = MakeRun("pcd");
  for (const std::string format : {"mcap", "rosbag2"}) {
    (void)ConvertTo(format, run / "frames", Path(format));
    const auto whole = FilesOf(Path(format));
    const ConvertChoices choices = {
        .recording = run / "frames", .directory = Path(format + "_begun"), .format = format};
    const fs::path bag =
        choices.directory / (format == "mcap" ? "frames.mcap.part" : "rosbag2/rosbag2_0.db3");
    const std::vector<std::function<void()>> harms = {
        [&] { fs::remove(bag); }, [&] { fs::resize_file(bag, 0); },
        [&] { fs::resize_file(bag, 50); },
        [&] { fs::resize_file(bag, fs::file_size(bag) * 2 / 3); },
        [&] { WriteFileWhole(bag, std::string(5000, 'x')); }};
    for (std::size_t i = 0; i < harms.size(); ++i) {
      EXPECT_FALSE(ConvertAll(choices, 2).is_complete);
      harms[i]();
      EXPECT_TRUE(ConvertAll(choices).is_complete);
      EXPECT_TRUE(FilesOf(choices.directory) == whole) << format << " " << i;
      fs::remove_all(choices.directory);
    }
  }
}

TEST_F(ConvertRecording, WritesThePointsOfAVendorsDriver) {
  const fs::path run = MakeRun("pcd");
  const ConvertResult result = ConvertAll(
      {.recording = run, .directory = Path("autoware"), .format = "mcap", .fields = "autoware"});
  EXPECT_TRUE(result.lost.contains("values of label"));
  EXPECT_FALSE(result.lost.contains("values of intensity"));
  EXPECT_EQ(ReadAll(Path("autoware/frames.mcap")).size(), 3U);
  EXPECT_THAT(MessageOf([&] {
                (void)ConvertAll({.recording = MakeClouds(),
                                  .directory = Path("velodyne"),
                                  .format = "mcap",
                                  .fields = "velodyne"});
              }),
              testing::StartsWith("--fields velodyne: needs ring (got none in "));
}

TEST_F(ConvertRecording, RefusesFieldsThatAreNotThere) {
  const fs::path clouds = MakeClouds();
  const auto message = [&](const std::string& fields, const std::string& format) {
    return MessageOf([&] {
      (void)ConvertAll(
          {.recording = clouds, .directory = Path("out"), .format = format, .fields = fields});
    });
  };
  EXPECT_EQ(message("x,y,z,ring", "pcd"),
            "--fields: must be among those of the recording, x, y, z, intensity, t, curvature, "
            "gps_time, class_id, echo_id, offset (got ring)");
  EXPECT_EQ(message("x,y,t", "ply"), "--fields: must contain x, y and z (got x,y,t)");
  EXPECT_EQ(message("x,y,z", "kitti"),
            "--fields: KITTI's are fixed, so it must be left out with --format kitti (got x,y,z)");
  EXPECT_EQ(message("autoware", "pcd"),
            "--fields autoware: must be with --format mcap or rosbag2 (got pcd)");
  EXPECT_FALSE(fs::exists(Path("out")));
}

}  // namespace
}  // namespace railcast
