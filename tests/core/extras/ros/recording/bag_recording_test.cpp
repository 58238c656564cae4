#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "core/base/input_file.h"
#include "core/base/units.h"
#include "core/extras/ros/bag/bag.h"
#include "core/extras/ros/messages/cdr.h"
#include "core/extras/ros/messages/geometry_messages.h"
#include "core/extras/ros/messages/point_layout.h"
#include "core/extras/ros/messages/sensor_messages.h"
#include "core/extras/ros/recording/cloud_message.h"
#include "core/extras/ros/recording/packet_messages.h"
#include "core/io/cloud/cloud_file.h"
#include "railcast/io/recording.h"
#include "tests/core/extras/ros/recording/made_bag.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/recording/read_all.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/support/captures.h"

namespace railcast {
namespace {

TEST(BagRecording, ReadsFieldsByNameAndOffsetOfEitherByteOrder) {
  MadeBag bag;
  bag.Add("/lidar/points", 0, CloudOf(kBagPoints, 7 * kSecond_ns));
  bag.Add("/lidar/points", 1, CloudOf(kBagPoints, 8 * kSecond_ns, true));
  const auto recording = OpenRecording(bag.Closed());
  EXPECT_EQ(recording->info().kind, "bag of ROS 2");
  const auto frames = ReadAll(*recording);
  ASSERT_EQ(frames.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    const Frame& frame = frames[i].frame;
    EXPECT_EQ(frame.index, i);
    EXPECT_EQ(frame.stamp_ns, static_cast<std::int64_t>(7 + i) * kSecond_ns);
    EXPECT_FALSE(frames[i].has_pose);
    // Points that are not finite, or all 0, are none.
    EXPECT_EQ(std::ranges::count_if(frame.range_m, [](float m) { return std::isfinite(m); }), 2);
    const auto first = std::ranges::find(frame.x, 1.5F) - frame.x.begin();
    EXPECT_EQ(frame.y[static_cast<std::size_t>(first)], 2.0F);
    EXPECT_EQ(frame.z[static_cast<std::size_t>(first)], 3.0F);
    EXPECT_TRUE(frames[i].Has("ring"));
  }
}

/// A turn of 16 rings at 100 s, with every third firing lost.
Frame TurnAt100s() {
  Frame frame;
  frame.Resize(16, 90, 1);
  frame.stamp_ns = 100 * kSecond_ns;
  for (std::uint32_t slot = 0; slot < frame.num_slots(); ++slot) {
    const std::uint32_t row = slot / 90;
    const std::uint32_t column = slot % 90;
    const double azimuth_rad = RadFromDeg(-4.0 * column);
    const double elevation_rad = RadFromDeg(2.0 * row - 15.0);
    frame.ring[slot] = static_cast<std::uint16_t>(row);
    frame.column[slot] = column;
    frame.time_ns[slot] = column * 1'000'000U;
    frame.outcome[slot] = Outcome::kNoSurface;
    frame.x[slot] = frame.y[slot] = frame.z[slot] = std::numeric_limits<float>::quiet_NaN();
    if (slot % 3 == 1) continue;
    frame.outcome[slot] = Outcome::kReturned;
    frame.range_m[slot] = 10.0F;
    frame.x[slot] = static_cast<float>(10.0 * std::cos(elevation_rad) * std::cos(azimuth_rad));
    frame.y[slot] = static_cast<float>(10.0 * std::cos(elevation_rad) * std::sin(azimuth_rad));
    frame.z[slot] = static_cast<float>(10.0 * std::sin(elevation_rad));
    frame.intensity[slot] = 0.5F;
    frame.return_count[slot] = 1;
  }
  return frame;
}

using Positions = std::vector<std::array<float, 3>>;

Positions PositionsOf(const Frame& frame) {
  Positions positions;
  for (std::size_t i = 0; i < frame.num_slots(); ++i) {
    if (!std::isnan(frame.x[i])) positions.push_back({frame.x[i], frame.y[i], frame.z[i]});
  }
  std::ranges::sort(positions);
  return positions;
}

void ExpectTurn(const RecordedFrame& recorded, const Frame& expected) {
  EXPECT_EQ(PositionsOf(recorded.frame), PositionsOf(expected));
  EXPECT_TRUE(recorded.is_grid);
  EXPECT_TRUE(recorded.Has("ring"));
  ASSERT_TRUE(recorded.Has("time_ns"));
  // Seconds as float64 are 15 ns apart at 100 s, and those of float32 since the stamp 7 ns.
  EXPECT_NEAR(static_cast<double>(recorded.frame.stamp_ns - expected.stamp_ns), 0.0, 30.0);
  EXPECT_NEAR(static_cast<double>(recorded.frame.duration_ns), 89e6, 30.0);
}

TEST(BagRecording, ReadsTheLayoutsOfTheDriversOfVendors) {
  const Frame turn = TurnAt100s();
  for (const auto layout :
       {ros::PointLayout::kRailcast, ros::PointLayout::kVelodyne, ros::PointLayout::kOuster,
        ros::PointLayout::kHesai, ros::PointLayout::kLivox, ros::PointLayout::kAutoware}) {
    SCOPED_TRACE(NameOf(layout));
    MadeBag bag;
    bag.Add("/points", 0, ros::MakeCloud(turn, {layout, {}}, "lidar"));
    const auto frames = ReadAll(bag.Closed());
    ASSERT_EQ(frames.size(), 1U);
    ExpectTurn(frames[0], turn);
  }
}

// Half way between two transforms, and through one that never changes.
TEST(BagRecording, HasThePosesThatItsTransformsSay) {
  MadeBag bag;
  const double half = std::sqrt(0.5);
  bag.Link("/tf_static", "base_link", "lidar", 0, {{0.0, 0.0, 2.0}, {}});
  bag.Link("/tf", "map", "base_link", 10 * kSecond_ns, {{100.0, 0.0, 0.0}, {}});
  bag.Add("/lidar/points", 10 * kSecond_ns, CloudOf(kBagPoints, 10 * kSecond_ns + kSecond_ns / 2));
  bag.Link("/tf", "map", "base_link", 11 * kSecond_ns,
           {{110.0, 4.0, 0.0}, {0.0, 0.0, half, half}});  // A quarter turn to the left.
  bag.Add("/lidar/points", 11 * kSecond_ns,
          CloudOf(kBagPoints, 11 * kSecond_ns + 900));  // Rounded.
  bag.Add("/lidar/points", 12 * kSecond_ns, CloudOf(kBagPoints, 12 * kSecond_ns));
  const auto frames = ReadAll(bag.Closed());
  ASSERT_EQ(frames.size(), 3U);
  ASSERT_TRUE(frames[0].has_pose && frames[1].has_pose);
  const Transform& pose = frames[0].frame.world_from_sensor;
  EXPECT_TRUE(pose.translation().isApprox(Vector3(105.0, 2.0, 2.0), 1e-12));
  EXPECT_TRUE(pose.linear().col(0).isApprox(Vector3(half, half, 0.0), 1e-12));
  // Nothing is known of the time after the last transform.
  EXPECT_FALSE(frames[2].has_pose);
}

TEST(BagRecording, MovesByLatchedTransformsUnlessAllAreEqual) {
  for (const bool is_moving : {true, false}) {
    MadeBag bag;
    for (int i = 0; i < 3; ++i) {
      bag.Link("/latched/tf", "map", "lidar", i * kSecond_ns,
               {{is_moving ? 10.0 * i : 10.0, 0, 0}, {}});
      bag.Add("/latched/points", i * kSecond_ns, CloudOf(kBagPoints, i * kSecond_ns));
    }
    const auto frames = ReadAll(bag.Closed());
    ASSERT_EQ(frames.size(), 3U);
    EXPECT_EQ(frames[0].frame.world_from_sensor.translation().x(), is_moving ? 0.0 : 10.0);
    EXPECT_EQ(frames[2].frame.world_from_sensor.translation().x(), is_moving ? 20.0 : 10.0);
  }
}

TEST(BagRecording, TellsOfPosesBetweenTransformsThatAreFarApart) {
  MadeBag bag;
  for (const std::int64_t tenths : {0, 1, 2, 3, 33, 34}) {
    bag.Link("/tf", "map", "lidar", tenths * kSecond_ns / 10, {{1.0 * double(tenths), 0, 0}, {}});
  }
  for (const std::int64_t tenths : {2, 18, 33}) {
    bag.Add("/lidar/points", 0, CloudOf(kBagPoints, tenths * kSecond_ns / 10));
  }
  const auto recording = OpenRecording(bag.Closed());
  const auto frames = ReadAll(*recording);
  ASSERT_EQ(frames.size(), 3U);
  EXPECT_NEAR(frames[1].frame.world_from_sensor.translation().x(), 18.0, 1e-9);
  EXPECT_EQ(recording->info().remarks->List(),
            (std::vector<Remark>{
                {RemarkKind::kPosesBridged, bag.file().string() + ": message 1", 1, "3 s"}}));
}

TEST(BagRecording, TellsOfTransformsFromAnotherFrameThanTheLast) {
  MadeBag bag;
  bag.Link("/tf", "odom", "lidar", 0, {{1.0, 0, 0}, {}});
  bag.Link("/tf", "map", "lidar", 0, {{2.0, 0, 0}, {}});
  bag.Add("/lidar/points", 0, CloudOf(kBagPoints, 0));
  const auto recording = OpenRecording(bag.Closed());
  EXPECT_EQ(ReadAll(*recording).at(0).frame.world_from_sensor.translation().x(), 2.0);
  EXPECT_EQ(recording->info().remarks->List(),
            (std::vector<Remark>{{RemarkKind::kTransformsLeftOut, "", 1,
                                  "\"lidar\" from \"odom\", not from \"map\""}}));
}

// Transforms of a simulated clock, clouds of the computer's.
TEST(BagRecording, TellsOfCloudsWithAnotherClockThanTheTransforms) {
  MadeBag bag;
  bag.Link("/tf_static", "base_link", "lidar", 0, {{0.0, 0.0, 2.0}, {}});
  for (int i = 0; i < 2; ++i)
    bag.Link("/tf", "map", "base_link", i * kSecond_ns, {{1.0, 0, 0}, {}});
  for (const std::int64_t time_s : {1, 61, 1'700'000'001})
    bag.Add("/lidar/points", kSecond_ns, CloudOf(kBagPoints, time_s * kSecond_ns));
  const auto recording = OpenRecording(bag.Closed());
  const auto frames = ReadAll(*recording);
  ASSERT_EQ(frames.size(), 3U);
  EXPECT_TRUE(frames[0].has_pose);
  EXPECT_FALSE(frames[1].has_pose) << "at its end a bag may lack transforms, which is not told";
  EXPECT_FALSE(frames[2].has_pose);
  EXPECT_EQ(recording->info().remarks->List(),
            (std::vector<Remark>{{RemarkKind::kClocksDiffer, bag.file().string() + ": message 2", 1,
                                  "1.7e+09 s from them"}}));
}

TEST(BagRecording, RefusesTransformsThatGoInCircles) {
  MadeBag bag;
  bag.Link("/tf", "mast", "lidar", 0, {});
  bag.Link("/tf", "lidar", "mast", 0, {});
  bag.Add("/lidar/points", 0, CloudOf(kBagPoints, 0));
  const auto file = bag.Closed();
  EXPECT_EQ(MessageOf([&] { (void)OpenRecording(file); }),
            file.string() + ": frames of reference must not go in circles (got \"lidar\")");
}

TEST(BagRecording, AsksWhichOfSeveralTopics) {
  MadeBag bag;
  bag.Add("/left/points", 0, CloudOf(kBagPoints, 0));
  bag.Add("/right/points", 0, CloudOf(kBagPoints, 5));
  bag.Add("/clock", 0, ros::Clock{});
  const auto file = bag.Closed();
  EXPECT_EQ(MessageOf([&] { (void)OpenRecording(file); }),
            file.string() + ": --topic: must be one of /left/points, /right/points (got none)");
  EXPECT_EQ(MessageOf([&] { (void)OpenRecording(TopicOfBag(file, "/clock")); }),
            file.string() +
                ": --topic: must be one of /left/points, /right/points (got /clock of "
                "rosgraph_msgs/msg/Clock)");
  const auto right = OpenRecording(TopicOfBag(file, "/right/points"));
  EXPECT_EQ(right->info().source, file.string() + ":/right/points");
  const auto frames = ReadAll(*right);
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(frames[0].frame.stamp_ns, 5);
  EXPECT_EQ(frames[0].name, file.string() + ":/right/points: message 0");
}

struct MadLayout {
  void (*change)(ros::PointCloud2& cloud);
  const char* message;
};

TEST(BagRecording, RefusesCloudsThatContradictThemselves) {
  for (const auto& [change, message] : std::vector<MadLayout>{
           {[](auto& cloud) { cloud.point_step = 0; }, "point_step: must be > 0 (got 0)"},
           {[](auto& cloud) { cloud.width = 4'000'000'000U; },
            "data: must have 68000000000 bytes (got 68)"},
           {[](auto& cloud) { cloud.height = 2; }, "data: must have 136 bytes (got 68)"},
           {[](auto& cloud) {
              cloud.height = 4'000'000'000U;
              cloud.row_step = 5;
            },
            "row_step: must be at least width x point_step, 68 (got 5)"},
           {[](auto& cloud) { cloud.fields[1].offset = 4'294'967'290U; },
            "fields: \"y\": must end within point_step, 17 (got 4294967294)"},
           {[](auto& cloud) { cloud.fields[3].count = 4'000'000'000U; },
            "fields: \"ring\": must end within point_step, 17 (got 8000000015)"},
           {[](auto& cloud) { cloud.fields[3].datatype = 9; },
            "fields: \"ring\": datatype: must be 1 to 8 (got 9)"},
           {[](auto& cloud) {
              cloud = CloudOf(kBagPoints, 0, true);
              cloud.fields[3].offset = 12;
            },
            "fields: must not share bytes (got \"z\" and \"ring\")"}}) {
    ros::PointCloud2 cloud = CloudOf(kBagPoints, 0);
    change(cloud);
    EXPECT_EQ(MessageOf([&] { (void)MakeCloud(cloud); }), message);
  }
}

TEST(BagRecording, SaysWhichMessageIsCutShort) {
  MadeBag bag;
  bag.Add("/lidar/points", 0, CloudOf(kBagPoints, 0));
  const auto file = bag.Closed();
  const TemporaryDirectory folder;
  const auto writer = bag::CreateMcap(folder.path() / "cut.mcap");
  const auto reader = bag::OpenBag(file);
  (void)writer->Add(reader->topics()[0]);
  const auto message = reader->Next();
  writer->Write({0, 0, message->data});
  writer->Write({0, 1, message->data.first(message->data.size() - 9)});
  writer->Close();
  const auto recording = OpenRecording(folder.path() / "cut.mcap");
  EXPECT_NO_THROW((*recording->Next())());
  EXPECT_TRUE(MessageOf([&] { (void)(*recording->Next())(); })
                  .starts_with((folder.path() / "cut.mcap").string() +
                               ": message 1: sensor_msgs/msg/PointCloud2: "));
}

TEST(BagRecording, OfAnEmptyTopicHasNoFrames) {
  MadeBag bag;
  bag.Add("/lidar/points", 0, CloudOf({}, 0));
  const auto frames = ReadAll(bag.Closed());
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(frames[0].frame.num_slots(), 0U);
}

// Written by Foxglove's library from a decoded cloud: every fourth of its points, in the layout of
// ROS's Velodyne driver with made-up other fields.
TEST(BagRecording, HasThePointsThatAnotherLibraryWrote) {
  const std::filesystem::path folder = RAILCAST_SHARED_DATA_DIR "/mcap/pointcloud2";
  const std::filesystem::path cloud =
      RAILCAST_SHARED_DATA_DIR "/lidar_packets_nebula/vls128_single_decoded.pcd";
  if (!exists(folder) || !exists(cloud)) GTEST_SKIP() << folder << " is not there";
  const Cloud table = ReadCloud(cloud);
  for (const char* name : {"vls128_pointcloud2_none.mcap", "vls128_pointcloud2_zstd.mcap"}) {
    const auto bag = bag::OpenBag(folder / name);
    std::size_t num_clouds = 0;
    while (const auto message = bag->Next()) {
      const auto read = MakeCloud(ros::FromCdr<ros::PointCloud2>(message->data));
      ASSERT_EQ(read.num_points(), 52'170U);
      for (const char* axis : {"x", "y", "z"}) {
        std::vector<float> expected;
        VisitField(table, *table.Find(axis), [&](std::size_t i, auto value) {
          if (i % 4 == 0) expected.push_back(static_cast<float>(value));
        });
        VisitField(read, *read.Find(axis), [&](std::size_t i, auto value) {
          ASSERT_EQ(static_cast<float>(value), expected.at(i));
        });
      }
      VisitField(read, *read.Find("ring"), [&](std::size_t i, auto value) {
        ASSERT_EQ(static_cast<std::size_t>(value), 4 * i % 128);
      });
      ++num_clouds;
    }
    EXPECT_EQ(num_clouds, 3U);
    const auto frames = ReadAll(folder / name);
    ASSERT_EQ(frames.size(), 3U);
    EXPECT_EQ(frames[2].frame.stamp_ns, 1'614'315'748'471'294'674);
    EXPECT_TRUE(frames[2].Has("time_ns"));
  }
}

// The first message of the file as bytes, encoded by another library.
TEST(BagRecording, GivesTheBytesOfMessagesAsTheyWere) {
  const std::filesystem::path folder = RAILCAST_SHARED_DATA_DIR "/mcap/pointcloud2";
  if (!exists(folder)) GTEST_SKIP() << folder << " is not there";
  const auto bag = bag::OpenBag(folder / "vls128_pointcloud2_zstd.mcap");
  const auto message = bag->Next();
  ASSERT_TRUE(message);
  const std::string bytes = ReadFileWhole(folder / "first_message.cdr");
  EXPECT_TRUE(std::ranges::equal(message->data, std::as_bytes(std::span(bytes))));
}

/// Packs the packets of a capture into messages of a driver of ROS.
template <typename Scan, typename Packet>
std::filesystem::path PackedAs(MadeBag& bag,
                               const std::vector<std::vector<std::uint8_t>>& packets) {
  Scan scan;
  for (const auto& packet : packets) {
    Packet& packed = scan.packets.emplace_back();
    if constexpr (requires { packed.data.resize(1); }) packed.data.resize(packet.size());
    std::ranges::copy(packet, packed.data.begin());
    if constexpr (requires { packed.size; }) {
      packed.size = static_cast<std::uint32_t>(packet.size());
    }
    if (scan.packets.size() == 50 || &packet == &packets.back()) {
      bag.Add("/packets", 0, scan);
      scan.packets.clear();
    }
  }
  return bag.Closed();
}

std::vector<std::vector<std::uint8_t>> PacketsOfCapture(const std::filesystem::path& file) {
  std::vector<std::vector<std::uint8_t>> packets;
  for (const auto& packet : PacketsInCapture(file)) {
    packets.emplace_back(packet.begin(), packet.end());
  }
  return packets;
}

void ExpectSamePoints(const std::vector<RecordedFrame>& frames,
                      const std::vector<RecordedFrame>& expected) {
  ASSERT_EQ(frames.size(), expected.size());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    EXPECT_TRUE(std::ranges::equal(frames[i].frame.x, expected[i].frame.x, [](float a, float b) {
      return a == b || (std::isnan(a) && std::isnan(b));
    }));
  }
}

// The same frames as the capture from which the packets were taken.
TEST(BagRecording, OfPacketsIsReadAsACaptureOfThem) {
  const std::filesystem::path capture =
      RAILCAST_SHARED_DATA_DIR "/lidar_packets_nebula/vlp32c_single.pcap";
  if (!exists(capture)) GTEST_SKIP() << capture << " is not there";
  const auto packets = PacketsOfCapture(capture);
  const auto expected = ReadAll(capture);
  MadeBag velodyne;
  MadeBag nebula;
  for (const auto& file :
       {PackedAs<ros::VelodyneScan, ros::VelodynePacketMessage>(velodyne, packets),
        PackedAs<ros::NebulaPackets, ros::NebulaPacket>(nebula, packets)}) {
    const auto recording = OpenRecording(file);
    EXPECT_EQ(recording->info().kind, "capture of VLP-32C");
    ExpectSamePoints(ReadAll(*recording), expected);
  }
}

// Ouster's driver records the metadata of its sensor on a topic beside the packets.
TEST(BagRecording, OfOustersPacketsHasTheirMetadataInATopic) {
  const std::filesystem::path folder = RAILCAST_SHARED_DATA_DIR "/lidar_ouster";
  if (!exists(folder)) GTEST_SKIP() << folder << " is not there";
  const std::filesystem::path capture = folder / "OS-2-128-U1_v2.3.0_1024x10.pcap";
  const std::string metadata = ReadFileWhole(folder / "OS-2-128-U1_v2.3.0_1024x10.json");
  for (const auto& text : {metadata, std::string("{}")}) {
    MadeBag bag;
    bag.Add("/ouster/metadata", 0, ros::StringMessage{text});
    for (const auto& packet : PacketsOfCapture(capture)) {
      bag.Add("/ouster/lidar_packets", 0, ros::OusterPacketMessage{packet});
    }
    const auto file = bag.Closed();
    if (text == metadata) {
      ExpectSamePoints(ReadAll(*OpenRecording(file)), ReadAll(capture));
    } else {
      EXPECT_TRUE(MessageOf([&] {
                    (void)OpenRecording(file);
                  }).starts_with(file.string() + ": /ouster/metadata: "));
    }
  }
}

TEST(BagRecording, RefusesPacketsLongerThanTheirMessage) {
  MadeBag bag;
  ros::PandarScan scan;
  scan.packets.emplace_back().size = 1501;
  bag.Add("/packets", 0, scan);
  const auto file = bag.Closed();
  EXPECT_EQ(MessageOf([&] { (void)OpenRecording(file); }),
            file.string() + ": message 0: size: must be at most 1500 (got 1501)");
}

}  // namespace
}  // namespace railcast
