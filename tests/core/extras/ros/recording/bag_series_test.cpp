#include "core/extras/ros/recording/bag_series.h"

#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <vector>

#include "core/extras/ros/bag/sqlite_database.h"
#include "core/extras/ros/mcap/mcap_writer.h"
#include "core/extras/ros/messages/sensor_messages.h"
#include "core/extras/ros/recording/bag_recording.h"
#include "core/extras/ros/recording/packet_messages.h"
#include "core/io/write_file.h"
#include "railcast/io/recording.h"
#include "tests/core/extras/ros/recording/made_bag.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/recording/read_all.h"
#include "tests/support/clouds.h"

namespace railcast {
namespace {

using Texts = std::vector<std::string>;

/// A cloud of some points over `span_s`.
ros::PointCloud2 TimedCloud(const std::string& frame_id, std::int64_t stamp_ns, float span_s) {
  ros::PointCloud2 cloud = CloudOf({{1, 2, 3}, {4, 5, 6}, {7, 8, 9}}, stamp_ns);
  cloud.header.frame_id = frame_id;
  cloud.fields[3] = {"time", 13, 7, 1};
  for (std::size_t point = 0; point < 3; ++point) {
    const float time_s = 0.5F * span_s * static_cast<float>(point);
    std::memcpy(&cloud.data[17 * point + 13], &time_s, sizeof time_s);
  }
  return cloud;
}

std::string FaultOfOpening(const std::filesystem::path& source) {
  return MessageOf([&] { (void)OpenRecording(source); });
}

TEST(BagSeries, AreListedAndChosenByFrameId) {
  for (const BagKind kind : {BagKind::kMcap, BagKind::kRosbag2}) {
    for (const int num_sensors : {2, 3}) {
      MadeBag bag(kind);
      const Texts names = {"front", "rear", "roof/left"};
      for (int i = 0; i < 4 * num_sensors; ++i) {
        const std::string& name = names.at(static_cast<std::size_t>(i % num_sensors));
        bag.Add("/points", i, TimedCloud(name, i * kSecond_ns, 0.1F));
      }
      const auto file = bag.Closed();
      EXPECT_EQ(FaultOfOpening(file),
                file.string() + ": /points: holds " + std::to_string(num_sensors) +
                    " series, by frame_id and channel: front (4 messages), rear (4 messages)" +
                    (num_sensors == 3 ? ", roof/left (4 messages)" : "") +
                    "; --frame-id picks one");
      for (int i = 0; i < num_sensors; ++i) {
        const auto source = file.string() + ":/#" + names.at(static_cast<std::size_t>(i));
        const auto frames = ReadAll(source);
        ASSERT_EQ(frames.size(), 4U);
        EXPECT_EQ(frames[1].frame.stamp_ns, (i + num_sensors) * kSecond_ns);
        EXPECT_EQ(frames[1].name, source + ": message 1");
      }
      EXPECT_EQ(FaultOfOpening(file.string() + ":/points#side"),
                file.string() + ":/points#side: /points: --frame-id: must be one of front, rear" +
                    (num_sensors == 3 ? ", roof/left" : "") + " (got side)");
    }
  }
}

// Messages name as many as one can read; the time grows with their number, not with its square.
TEST(BagSeries, AreListedUpToTwenty) {
  for (const int num_series : {20, 21, 3000}) {
    MadeBag bag;
    for (int i = 0; i < num_series; ++i) {
      bag.Add("/points", i, TimedCloud("lidar_" + std::to_string(10'000 + i), 0, 0.1F));
    }
    const auto file = bag.Closed();
    std::string names;
    std::string numbers;
    for (int i = 0; i < 20; ++i) {
      const std::string name = "lidar_" + std::to_string(10'000 + i);
      names += (i == 0 ? "" : ", ") + name;
      numbers += (i == 0 ? "" : ", ") + name + " (1 message)";
    }
    const std::string others =
        num_series == 20 ? "" : " and " + std::to_string(num_series - 20) + " others";
    EXPECT_EQ(FaultOfOpening(file), file.string() + ": /points: holds " +
                                        std::to_string(num_series) +
                                        " series, by frame_id and channel: " + numbers + others +
                                        "; --frame-id picks one");
    EXPECT_EQ(FaultOfOpening(file.string() + ":/#side"),
              file.string() + ":/#side: /points: --frame-id: must be one of " + names + others +
                  " (got side)");
    EXPECT_EQ(ReadAll(file.string() + ":/#lidar_" + std::to_string(9999 + num_series)).size(), 1U);
  }
}

// A sensor that starts sends messages without points, and some drivers these without a name.
TEST(BagSeries, TakeMessagesWithoutPointsAndName) {
  for (const BagKind kind : {BagKind::kMcap, BagKind::kRosbag2}) {
    for (const std::string series : {"front", "rear"}) {
      MadeBag bag(kind);
      for (const auto& [frame_id, num_points] : std::vector<std::pair<std::string, std::size_t>>{
               {"", 0}, {"front", 2}, {"rear", 2}, {"rear", 0}, {"", 0}, {"front", 2}}) {
        ros::PointCloud2 cloud = CloudOf({kBagPoints.begin(), kBagPoints.begin() + num_points}, 0);
        cloud.header.frame_id = frame_id;
        bag.Add("/points", 0, cloud);
      }
      std::vector<std::size_t> num_slots;
      for (const auto& frame : ReadAll(bag.Closed().string() + ":/#" + series)) {
        num_slots.push_back(frame.slot_of_entry.size());
      }
      const std::vector<std::size_t> expected = series == "front"
                                                    ? std::vector<std::size_t>{0, 2, 0, 2}
                                                    : std::vector<std::size_t>{0, 2, 0, 0};
      EXPECT_EQ(num_slots, expected);
    }
  }
}

TEST(BagSeries, AreThoseOfPacketsToo) {
  MadeBag bag;
  for (const char* const name : {"front", "rear"}) {
    ros::VelodyneScan scan;
    scan.header.frame_id = name;
    scan.packets.emplace_back();
    bag.Add("/packets", 0, scan);
  }
  const auto file = bag.Closed();
  EXPECT_EQ(FaultOfOpening(file),
            file.string() +
                ": /packets: holds 2 series, by frame_id and channel: front (1 message), rear (1 "
                "message); --frame-id picks one");
  const auto packets = FindBagPackets({file, "/packets", "rear"})->open();
  EXPECT_TRUE(packets->Next());
  EXPECT_FALSE(packets->Next());
}

/// Writes clouds with these stamps into channels 3, 7, ... of one topic.
std::filesystem::path WithChannels(const std::filesystem::path& folder,
                                   const std::vector<std::vector<std::int64_t>>& stamps_s) {
  std::string bytes;
  mcap::McapWriter writer(
      [&](mcap::ByteSpan more) {
        bytes.append(reinterpret_cast<const char*>(more.data()), more.size());
      },
      {"ros2", "test"}, mcap::McapCompression::kNone, {});
  writer.Write(mcap::McapSchema{1, std::string(ros::PointCloud2::kName), "ros2msg", ""});
  std::uint16_t id = 3;
  for (const auto& channel_s : stamps_s) {
    writer.Write(mcap::McapChannel{id, 1, "/points", "cdr", {}});
    for (const std::int64_t stamp_s : channel_s) {
      const auto data = ros::ToCdr(TimedCloud("lidar", stamp_s * kSecond_ns, 0.1F));
      writer.Write(mcap::McapMessage{.channel_id = id,
                                     .log_time = static_cast<std::uint64_t>(stamp_s),
                                     .publish_time = 0,
                                     .data = data});
    }
    id = static_cast<std::uint16_t>(id + 4);
  }
  writer.Finish();
  WriteFileWhole(folder / "merged.mcap", bytes);
  return folder / "merged.mcap";
}

TEST(BagSeries, AreChannelsThatOverlapInTime) {
  const TemporaryDirectory folder;
  const auto file = WithChannels(folder.path(), {{1, 3, 5}, {2, 4}});
  EXPECT_EQ(FaultOfOpening(file),
            file.string() +
                ": /points: holds 2 series, by frame_id and channel: lidar#3 (3 messages), lidar#7 "
                "(2 messages); --frame-id picks one");
  EXPECT_EQ(ReadAll(file.string() + ":/points#lidar#7").size(), 2U);
  EXPECT_EQ(FaultOfOpening(file.string() + ":/#lidar"),
            file.string() +
                ":/#lidar: /points: --frame-id: must be one of lidar#3, lidar#7 (got "
                "lidar)");
}

// As of a drive that was recorded in two files and merged.
TEST(BagSeries, AreOneWhereChannelsFollowEachOther) {
  const TemporaryDirectory folder;
  EXPECT_EQ(ReadAll(WithChannels(folder.path(), {{4, 5}, {1, 2, 3}})).size(), 5U);
}

// A database may have several topics of one name.
TEST(BagSeries, AreThoseOfDatabasesToo) {
  MadeBag bag(BagKind::kRosbag2);
  for (int i = 0; i < 4; ++i) bag.Add("/points", i, TimedCloud("lidar", i * kSecond_ns, 0.1F));
  const auto file = bag.Closed() / "run_0.db3";
  {
    bag::SqliteDatabase database(file, bag::SqliteAccess::kChange, "bag");
    database.Run(
        "INSERT INTO topics SELECT 9, name, type, serialization_format, offered_qos_profiles, "
        "type_description_hash FROM topics; UPDATE messages SET topic_id = 9 WHERE id % 2 = 0");
  }
  EXPECT_EQ(FaultOfOpening(file),
            file.string() +
                ": /points: holds 2 series, by frame_id and channel: lidar#1 (2 messages), lidar#9 "
                "(2 messages); --frame-id picks one");
  EXPECT_EQ(ReadAll(file.string() + ":/points#lidar#9").size(), 2U);
}

TEST(BagSeries, TellsOfFramesThatOverlapInTime) {
  for (const auto& [period_ms, text] :
       std::vector<std::pair<int, std::string>>{{50, "spans-overlap 4: 44 of 94 ms"},
                                                {33, "spans-overlap 4: 61 of 94 ms"},
                                                {0, "spans-overlap 4: 94 of 94 ms"},
                                                {90, ""},
                                                {100, ""}}) {
    MadeBag bag;
    for (int i = 0; i < 5; ++i) {
      bag.Add("/points", i, TimedCloud("lidar", i * period_ms * kSecond_ns / 1000, 0.094F));
    }
    const auto recording = OpenRecording(bag.Closed());
    std::vector<Recording::FrameReader> readers;
    while (auto read = recording->Next()) readers.push_back(*read);
    for (const std::size_t i : {3U, 0U, 4U, 2U, 1U}) (void)readers.at(i)();
    Texts remarks;
    for (const Remark& remark : recording->info().remarks->List()) {
      remarks.push_back(std::string(remark.type().name) + " " + std::to_string(remark.number) +
                        ": " + remark.detail);
      EXPECT_EQ(remark.place, bag.file().string() + ": message 1");
    }
    EXPECT_EQ(remarks, text.empty() ? Texts{} : Texts{text});
  }
}

// As where only every other frame of a long recording is read, and some of the rest later.
TEST(BagSeries, CompareFramesInTimeAsLongAsTheyAreKept) {
  const auto remarks = std::make_shared<RemarkLog>();
  OverlapCheck check(remarks);
  const auto take = [&](std::uint32_t index) {
    RecordedFrame recorded;
    recorded.name = std::to_string(index);
    recorded.frame.index = index;
    recorded.frame.duration_ns = 100;
    check.Take(recorded);
  };
  constexpr std::uint32_t kEnd = 20'000;
  for (std::uint32_t index = 0; index < kEnd; index += 2) take(index);
  take(1);  // Its neighbours are forgotten.
  EXPECT_TRUE(remarks->List().empty());
  take(kEnd - 3);
  ASSERT_EQ(remarks->List().size(), 1U);
  EXPECT_EQ(remarks->List()[0].number, 2U);
  EXPECT_EQ(remarks->List()[0].place, std::to_string(kEnd - 3));
}

// The time of opening grows with the number of channels, not with its square.
TEST(BagSeries, AreFoundAmongAsManyChannelsAsThereCanBe) {
  const TemporaryDirectory folder;
  std::string bytes;
  mcap::McapWriter writer(
      [&](mcap::ByteSpan more) {
        bytes.append(reinterpret_cast<const char*>(more.data()), more.size());
      },
      {"ros2", "test"}, mcap::McapCompression::kNone, {});
  writer.Write(mcap::McapSchema{1, std::string(ros::PointCloud2::kName), "ros2msg", ""});
  constexpr std::uint16_t kMost = 65'535;
  for (std::uint16_t id = 1; id < kMost; ++id) {
    writer.Write(mcap::McapChannel{id, 1, "/points_" + std::to_string(id), "cdr", {}});
  }
  const auto data = ros::ToCdr(TimedCloud("lidar", 0, 0.1F));
  writer.Write(
      mcap::McapMessage{.channel_id = kMost - 1, .log_time = 0, .publish_time = 0, .data = data});
  writer.Finish();
  WriteFileWhole(folder.path() / "many.mcap", bytes);
  EXPECT_EQ(ReadAll(folder.path() / "many.mcap:/points_65534").size(), 1U);
}

TEST(BagSeries, StandBehindTheTopic) {
  MadeBag bag;
  bag.Add("/points", 0, CloudOf(kBagPoints, 0));
  const std::string file = bag.Closed().string();
  for (const auto& [source, topic, series] :
       std::vector<std::array<std::string, 3>>{{":/points", "/points", ""},
                                               {":/points#a/b", "/points", "a/b"},
                                               {":/#front", "", "front"},
                                               {":/##3", "", "#3"}}) {
    const auto found = FindBag(file + source);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->bag, file);
    EXPECT_EQ(found->topic, topic);
    EXPECT_EQ(found->series, series);
  }
}

}  // namespace
}  // namespace railcast
