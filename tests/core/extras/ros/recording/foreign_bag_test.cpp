// Bags as drivers and recorders of others write them, in other ways than the messages' definitions
// say.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include "core/base/input_file.h"
#include "core/extras/ros/bag/sqlite_database.h"
#include "core/extras/ros/mcap/byte_file.h"
#include "core/extras/ros/mcap/mcap_index.h"
#include "core/extras/ros/recording/bag_recording.h"
#include "core/extras/ros/recording/cloud_message.h"
#include "core/extras/ros/recording/packet_messages.h"
#include "core/io/write_file.h"
#include "railcast/io/recording.h"
#include "tests/core/extras/ros/recording/made_bag.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/recording/read_all.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/support/clouds.h"

namespace railcast {
namespace {

using TextList = std::vector<std::string>;

const std::vector<std::array<float, 3>> kFourPoints = {
    {1.0F, 2.0F, 3.0F}, {4.0F, 5.0F, 6.0F}, {7.0F, 8.0F, 9.0F}, {10.0F, 11.0F, 12.0F}};

TEST(ForeignBag, TakesRowsByTheirDataWhateverTheStepOfRowsIs) {
  for (const std::uint32_t row_step : {0U, 5U, 68U}) {
    ros::PointCloud2 message = CloudOf(kFourPoints, 0);
    message.height = message.width = 2;
    message.row_step = row_step;
    const Cloud cloud = MakeCloud(message);
    EXPECT_EQ(FieldNumbers(cloud, "x"), (std::vector<double>{1.0, 4.0, 7.0, 10.0})) << row_step;
    EXPECT_EQ(RemarkTexts(cloud.remarks), TextList());
  }
}

TEST(ForeignBag, TellsOfPointsBeyondThoseThatTheMessageStates) {
  ros::PointCloud2 message = CloudOf(kFourPoints, 0);
  message.width = 3;
  EXPECT_EQ(RemarkTexts(MakeCloud(message).remarks), TextList{"points-beyond 1"});
  message.data.push_back(7);
  EXPECT_EQ(RemarkTexts(MakeCloud(message).remarks),
            (TextList{"points-beyond 1", "surplus-bytes 1"}));
  // The second point of each of two rows.
  message = CloudOf(kFourPoints, 0);
  message.height = 2;
  message.width = 1;
  message.row_step = 34;
  const Cloud rows = MakeCloud(message);
  EXPECT_EQ(FieldNumbers(rows, "x"), (std::vector<double>{1.0, 7.0}));
  EXPECT_EQ(RemarkTexts(rows.remarks), TextList{"points-beyond 2"});
}

TEST(ForeignBag, TakesZerosForPadding) {
  ros::PointCloud2 message = CloudOf(kFourPoints, 0);
  message.data.resize(message.data.size() + 100);
  EXPECT_EQ(RemarkTexts(MakeCloud(message).remarks), TextList());
}

ros::PointCloud2 NoCloudAt(std::int64_t stamp_ns) {
  ros::PointCloud2 message;
  message.header.stamp = TimeAt(stamp_ns);
  return message;
}

TEST(ForeignBag, HasAFrameForAMessageWithoutPointsAndFields) {
  MadeBag bag;
  bag.Add("/points", 0, CloudOf(kFourPoints, 0));
  bag.Add("/points", 1, NoCloudAt(kSecond_ns));
  bag.Add("/points", 2, CloudOf(kFourPoints, 2 * kSecond_ns));
  const auto frames = ReadAll(bag.Closed());
  ASSERT_EQ(frames.size(), 3U);
  EXPECT_EQ(frames[1].frame.num_slots(), 0U);
  EXPECT_EQ(frames[1].frame.stamp_ns, kSecond_ns);
}

TEST(ForeignBag, TellsTheByteOrderByTheValues) {
  for (const bool is_bigendian : {false, true}) {
    ros::PointCloud2 message = CloudOf(kFourPoints, 0, is_bigendian);
    message.is_bigendian = !is_bigendian;
    const Cloud cloud = MakeCloud(message);
    EXPECT_EQ(FieldNumbers(cloud, "y"), (std::vector<double>{2.0, 5.0, 8.0, 11.0}));
    EXPECT_EQ(FieldNumbers(cloud, "ring"), (std::vector<double>{0.0, 1.0, 2.0, 3.0}));
    EXPECT_EQ(RemarkTexts(cloud.remarks), TextList{"byte-order-guessed 1"});
  }
}

// A fifth of a turn of a driver that counts from its start, in three messages 1.2 s apart.
TEST(ForeignBag, TakesTimesFarFromTheStampAsDifferences) {
  MadeBag bag;
  for (std::int64_t i = 0; i < 3; ++i) {
    const std::int64_t start_ns = i * 1'200'000'000;
    ros::PointCloud2 message = CloudOf(kFourPoints, 7 * kSecond_ns + start_ns);
    message.fields[3] = {"time", 13, 7, 1};
    for (std::size_t point = 0; point < 4; ++point) {
      const auto time_s = static_cast<float>(1e-9 * static_cast<double>(start_ns)) +
                          0.025F * static_cast<float>(point);
      std::memcpy(&message.data[17 * point + 13], &time_s, sizeof time_s);
    }
    bag.Add("/points", start_ns, message);
  }
  const auto recording = OpenRecording(bag.Closed());
  const auto frames = ReadAll(*recording);
  ASSERT_EQ(frames.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(frames[i].frame.stamp_ns,
              7 * kSecond_ns + static_cast<std::int64_t>(i) * 1'200'000'000);
    // float32 rounds 2.4 s to 0.24 us.
    EXPECT_NEAR(frames[i].frame.duration_ns, 75e6, 500.0);
  }
  EXPECT_EQ(RemarkTexts(recording->info().remarks->List()), TextList{"times-relative 2"});
}

// As Velodyne's driver does without timestamp_first_packet.
TEST(ForeignBag, TakesTimesBeforeAStampAtTheEndOfTheTurn) {
  MadeBag bag;
  ros::PointCloud2 message = CloudOf(kFourPoints, 7 * kSecond_ns);
  message.fields[3] = {"time", 13, 7, 1};
  for (std::size_t point = 0; point < 4; ++point) {
    const float time_s = 0.025F * static_cast<float>(point) - 0.076F;
    std::memcpy(&message.data[17 * point + 13], &time_s, sizeof time_s);
  }
  bag.Add("/points", 0, message);
  const auto recording = OpenRecording(bag.Closed());
  EXPECT_NEAR(static_cast<double>(ReadAll(*recording).at(0).frame.stamp_ns), 6.924e9, 10.0);
  EXPECT_EQ(RemarkTexts(recording->info().remarks->List()), TextList());
}

/// Writes a bag of one message of this type in a folder, and returns its database.
std::filesystem::path WriteDatabase(const std::filesystem::path& folder,
                                    std::string_view type = ros::PointCloud2::kName) {
  const auto writer = bag::CreateRosbag2(folder / "bag");
  const auto topic =
      writer->Add({.name = "/points", .type = std::string(type), .definition = {}, .hash = {}});
  writer->Write({topic, 0, ros::ToCdr(CloudOf(kFourPoints, 0))});
  writer->Close();
  return folder / "bag/bag_0.db3";
}

TEST(ForeignBag, ReadsTypesThatAreNamedAsInRos1) {
  MadeBag bag;
  bag.Add("/points", 0, CloudOf(kFourPoints, 0), "sensor_msgs/PointCloud2");
  EXPECT_EQ(ReadAll(bag.Closed()).size(), 1U);
  const TemporaryDirectory folder;
  EXPECT_EQ(ReadAll(WriteDatabase(folder.path(), "sensor_msgs/PointCloud2")).size(), 1U);
}

TEST(ForeignBag, ListsItsTopicsWhereNoneCanBeRead) {
  MadeBag bag;
  bag.Add("/clock", 0, ros::Clock{});
  bag.Add("/draco", 0, ros::Clock{}, "point_cloud_interfaces/msg/CompressedPointCloud2");
  const auto file = bag.Closed();
  EXPECT_EQ(MessageOf([&] { (void)OpenRecording(file); }),
            file.string() +
                ": must have a topic of type sensor_msgs/msg/PointCloud2 or of a sensor's packets "
                "(got /clock of rosgraph_msgs/msg/Clock; /draco of "
                "point_cloud_interfaces/msg/CompressedPointCloud2, compressed, which is not read: "
                "ros2 run point_cloud_transport republish makes clouds of "
                "sensor_msgs/msg/PointCloud2)");
  MadeBag empty;
  const auto none = empty.Closed();
  EXPECT_EQ(MessageOf([&] { (void)OpenRecording(none); }),
            none.string() +
                ": must have a topic of type sensor_msgs/msg/PointCloud2 or of a "
                "sensor's packets (got none)");
}

ros::LivoxCloud LivoxCloudAt(std::int64_t stamp_ns,
                             std::uint64_t timebase,
                             std::uint32_t offset_ns) {
  return {.header = {TimeAt(stamp_ns), "livox"},
          .timebase = timebase,
          .point_num = 3,
          .points = {{offset_ns + 20, 1.0F, 2.0F, 3.0F, 200, 16, 1},
                     {offset_ns, 0.0F, 0.0F, 0.0F, 0, 0, 2},
                     {offset_ns + 40, 4.0F, 5.0F, 6.0F, 10, 0, 3}}};
}

TEST(ForeignBag, ReadsTheCloudsOfLivoxsDrivers) {
  for (const char* type : {"livox_ros_driver2/msg/CustomMsg", "livox_ros_driver/CustomMsg"}) {
    MadeBag bag;
    bag.Add("/livox/lidar", 0, LivoxCloudAt(kSecond_ns, kSecond_ns, 5), type);
    const auto frames = ReadAll(bag.Closed());
    ASSERT_EQ(frames.size(), 1U);
    const Frame& frame = frames[0].frame;
    EXPECT_EQ(frame.stamp_ns, kSecond_ns + 5);
    EXPECT_EQ(frame.duration_ns, 40U);
    const auto last = static_cast<std::size_t>(std::ranges::find(frame.x, 4.0F) - frame.x.begin());
    EXPECT_EQ(frame.z.at(last), 6.0F);
    EXPECT_EQ(frame.intensity.at(last), 10.0F);
    EXPECT_EQ(frame.ring.at(last), 3);
    EXPECT_EQ(frame.time_ns.at(last), 40U);
    // Nothing came back where a point is at 0.
    EXPECT_EQ(std::ranges::count_if(frame.x, [](float x) { return !std::isnan(x); }), 2);
  }
}

// Whose stamps stand still while the offsets grow.
TEST(ForeignBag, TakesTheTimesOfLivoxFromItsTimeBase) {
  MadeBag bag;
  bag.Add("/livox/lidar", 0, LivoxCloudAt(kSecond_ns, kSecond_ns, 0));
  bag.Add("/livox/lidar", 1, LivoxCloudAt(kSecond_ns, kSecond_ns, 2'000'000'000));
  // The sensor's own clock.
  bag.Add("/livox/lidar", 2, LivoxCloudAt(5 * kSecond_ns, 77, 2'000'000'000));
  const auto recording = OpenRecording(bag.Closed());
  const auto frames = ReadAll(*recording);
  ASSERT_EQ(frames.size(), 3U);
  EXPECT_EQ(frames[0].frame.stamp_ns, kSecond_ns);
  EXPECT_EQ(frames[1].frame.stamp_ns, 3 * kSecond_ns);
  EXPECT_EQ(frames[2].frame.stamp_ns, 5 * kSecond_ns);
  EXPECT_EQ(RemarkTexts(recording->info().remarks->List()), TextList{"times-relative 1"});
}

TEST(ForeignBag, TellsOfPointsBeyondThoseThatLivoxStates) {
  ros::LivoxCloud message = LivoxCloudAt(0, 0, 0);
  std::int64_t first_ns = 0;
  message.point_num = 2;
  EXPECT_EQ(RemarkTexts(MakeCloud(message, first_ns).remarks), TextList{"points-beyond 1"});
  message.point_num = 4;
  EXPECT_EQ(MessageOf([&] { (void)MakeCloud(message, first_ns); }),
            "point_num: must be at most the number of points, 3 (got 4)");
}

TEST(ForeignBag, TellsThatItsEndIsCutOff) {
  MadeBag bag;
  for (std::int64_t i = 0; i < 3; ++i) {
    bag.Add("/points", i, CloudOf(kFourPoints, i));
    bag.Commit();
  }
  const auto file = bag.Closed();
  const auto last = mcap::ReadIndex(mcap::ByteFile(file, "run")).chunks.at(2).chunk_start_offset;
  std::filesystem::resize_file(file, last + 30);
  const auto recording = OpenRecording(file);
  EXPECT_EQ(ReadAll(*recording).size(), 2U);
  const auto remarks = recording->info().remarks->List();
  ASSERT_EQ(RemarkTexts(remarks), TextList{"recording-cut 1"});
  EXPECT_TRUE(remarks[0].place.starts_with(file.string() + ": record at ")) << remarks[0].place;
}

TEST(ForeignBag, TellsWhatIsWrongBehindItsData) {
  MadeBag bag;
  bag.Add("/points", 0, CloudOf(kFourPoints, 0));
  const auto file = bag.Closed();
  const std::string whole = ReadFileWhole(file);
  const auto told = [&](const std::string& bytes) {
    WriteFileWhole(file, bytes);
    const auto recording = OpenRecording(file);
    EXPECT_EQ(ReadAll(*recording).size(), 1U);
    return RemarkTexts(recording->info().remarks->List());
  };
  EXPECT_EQ(told(whole), TextList{});
  EXPECT_EQ(told(whole + "junk"), TextList{"surplus-bytes 4"});
  EXPECT_EQ(told(whole.substr(0, whole.size() - 1)), TextList{"recording-cut 1"});
  EXPECT_EQ(told(whole.substr(0, whole.size() - 37)), TextList{"recording-cut 1"});
}

TEST(ForeignBag, RefusesATopicOfTwoEncodings) {
  const std::string type(ros::PointCloud2::kName);
  const bag::BagTopic points{.name = "/points", .type = type, .definition = {}, .hash = {}};
  bag::BagTopic other = points;
  other.encoding = "json";
  for (const char* name : {"", "/points"}) {
    const auto fault = [&] {
      return MessageOf([&] { (void)PickTopic({points, other}, "a.mcap", name); });
    };
    other.name = "/points";
    EXPECT_EQ(fault(), "a.mcap: /points: must be a topic of one type (got " + type +
                           " as cdr and " + type + " as json)");
    other.name = "/others";
    EXPECT_EQ(fault(), "no error");
  }
}

TEST(ForeignBag, TellsOfFilesThatItsMetadataDoNotName) {
  const TemporaryDirectory folder;
  const auto file = WriteDatabase(folder.path());
  std::filesystem::copy_file(file, file.parent_path() / "bag_1.db3");
  const auto recording = OpenRecording(file.parent_path());
  EXPECT_EQ(ReadAll(*recording).size(), 1U);
  EXPECT_EQ(RemarkTexts(recording->info().remarks->List()), TextList{"files-left-out 1"});
}

TEST(ForeignBag, TellsThatItsRecorderWasInterrupted) {
  const TemporaryDirectory folder;
  const auto file = WriteDatabase(folder.path());
  const std::filesystem::path copy = folder.path() / "copy.db3";
  {
    bag::SqliteDatabase database(file, bag::SqliteAccess::kChange, "bag");
    database.Run("PRAGMA cache_size = 1; BEGIN; UPDATE messages SET data = zeroblob(200000)");
    std::filesystem::copy_file(file, copy);
    std::filesystem::copy_file(file.string() + "-journal", copy.string() + "-journal");
  }
  const auto recording = OpenRecording(copy);
  EXPECT_EQ(ReadAll(*recording).size(), 1U);
  EXPECT_EQ(RemarkTexts(recording->info().remarks->List()), TextList{"recording-cut 1"});
}

}  // namespace
}  // namespace railcast
