#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/input_file.h"
#include "core/extras/packets/pcap/pcap_reader.h"
#include "core/extras/ros/bag/bag.h"
#include "core/extras/ros/messages/cdr.h"
#include "core/extras/ros/messages/sensor_messages.h"
#include "core/extras/ros/recording/cloud_message.h"
#include "core/extras/ros/recording/packet_messages.h"
#include "core/io/write_file.h"
#include "generator/extras/insert/run/insert_run.h"
#include "tests/core/extras/packets/ouster/shared_captures.h"
#include "tests/core/extras/ros/bag/read_bag.h"
#include "tests/core/extras/ros/recording/made_bag.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/recording/read_all.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/extras/insert/packets/frame_edits.h"
#include "tests/generator/extras/insert/packets/hand_edits.h"
#include "tests/generator/extras/insert/plan/plan_project.h"
#include "tests/support/hesai_bag.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;

/// Copies a bag of packets without edits and with edits of all kinds.
void ExpectEditsOfPackets(const fs::path& bag) {
  const TemporaryDirectory folder;
  static_cast<void>(CopyWithEdits(bag, folder.path() / "same", WithoutEdits));
  EXPECT_TRUE(ReadFileWhole(folder.path() / "same" / bag.filename()) == ReadFileWhole(bag));
  const auto frames = CopyWithEdits(bag, folder.path() / "edited", EditedByHand);
  const fs::path edited = folder.path() / "edited" / bag.filename();
  const auto read = ReadAll(edited);
  ASSERT_EQ(read.size(), frames.size());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    SCOPED_TRACE(i);
    ExpectEdits(frames[i], read[i]);
  }
  // All other messages are as they were, and so is the size of those with packets.
  const auto before = bag::MessagesIn(bag);
  const auto after = bag::MessagesIn(edited);
  ASSERT_EQ(after.size(), before.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_EQ(after[i].topic, before[i].topic);
    EXPECT_EQ(after[i].time_ns, before[i].time_ns);
    EXPECT_EQ(after[i].data.size(), before[i].data.size());
    if (before[i].topic == "/other") {
      EXPECT_EQ(after[i].data, before[i].data);
    }
  }
}

TEST(BagOutput, EditsThePacketsOfRealBags) {
  for (const char* name : {"xt32", "qt128"}) {
    if (const auto why = WhyNoHesaiBag(name); !why.empty()) GTEST_SKIP() << why;
    SCOPED_TRACE(name);
    ExpectEditsOfPackets(HesaiBag(name));
  }
}

template <typename Message>
void AddMessage(bag::BagWriter& bag,
                const std::string& topic,
                std::int64_t time_ns,
                const Message& message) {
  const std::size_t index =
      bag.Add({.name = topic, .type = std::string(Message::kName), .definition = {}, .hash = {}});
  const auto data = ros::ToCdr(message);
  bag.Write({index, time_ns, data});
}

/// Packs the packets of a capture into messages of 40, beside another topic; chunks have three
/// messages each, and every fourth message was recorded later than the one after it.
template <typename Scan>
fs::path PackedInto(const fs::path& file, const fs::path& capture) {
  PcapReader reader(capture);
  const auto bag = bag::CreateMcap(file);
  Scan scan;
  std::int64_t num_messages = 0;
  const auto add = [&] {
    const std::int64_t time_ns = 100 * num_messages + (num_messages % 4 == 0 ? 150 : 0);
    AddMessage(*bag, "/packets", time_ns, scan);
    AddMessage(*bag, "/other", time_ns, ros::StringMessage{"other " + std::to_string(time_ns)});
    if (++num_messages % 3 == 0) bag->Commit();
    scan.packets.clear();
  };
  while (const auto datagram = reader.Next()) {
    auto& packet = scan.packets.emplace_back();
    if constexpr (requires { packet.data.resize(1); }) packet.data.resize(datagram->payload.size());
    std::ranges::copy(datagram->payload, packet.data.begin());
    if (scan.packets.size() == 40) add();
  }
  add();
  bag->Close();
  return file;
}

TEST(BagOutput, EditsPacketsOfVelodyneAndNebulaDrivers) {
  const fs::path vlp32c = OusterCapture::Path("lidar_packets_nebula/vlp32c_single.pcap");
  if (!exists(vlp32c)) GTEST_SKIP() << vlp32c << " is not there";
  const TemporaryDirectory folder;
  ExpectEditsOfPackets(PackedInto<ros::VelodyneScan>(folder.path() / "velodyne.mcap", vlp32c));
  const fs::path pandar = OusterCapture::Path("lidar_packets_nebula/pandar64.pcap");
  ExpectEditsOfPackets(PackedInto<ros::NebulaPackets>(folder.path() / "nebula.mcap", pandar));
}

TEST(BagOutput, EditsPacketsOfOustersDriver) {
  if (!kOs2Capture.is_there()) GTEST_SKIP() << kOs2Capture.pcap << " is not there";
  const TemporaryDirectory folder;
  const fs::path file = folder.path() / "ouster.mcap";
  const auto bag = bag::CreateMcap(file);
  AddMessage(*bag, "/ouster/metadata", 0,
             ros::StringMessage{ReadFileWhole(OusterCapture::Path(kOs2Capture.json))});
  std::int64_t time_ns = 1;
  for (const auto& packet : LidarPacketsOf(kOs2Capture)) {
    AddMessage(*bag, "/ouster/lidar_packets", time_ns++,
               ros::OusterPacketMessage{{packet.begin(), packet.end()}});
    if (time_ns % 10 == 0) bag->Commit();
  }
  bag->Close();
  ExpectEditsOfPackets(file);
}

/// The points of a message by entry.
std::vector<std::array<float, 4>> PointsOf(const std::string& data) {
  const auto table = MakeCloud(ros::FromCdr<ros::PointCloud2>(std::as_bytes(std::span(data))));
  std::vector<std::array<float, 4>> points(table.num_points());
  std::size_t i = 0;
  for (const char* name : {"x", "y", "z", "intensity"}) {
    VisitField(table, *table.Find(name), [&](std::size_t point, auto value) {
      points[point].at(i) = static_cast<float>(value);
    });
    ++i;
  }
  return points;
}

/// The firings of a cloud's frame, with the entries of its slots.
RecordedFirings FiringsOf(RecordedFrame recorded, const std::vector<std::array<float, 4>>& points) {
  std::multimap<std::array<float, 3>, std::uint32_t> entries;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    entries.emplace(std::array{points[i][0], points[i][1], points[i][2]}, i);
  }
  RecordedFirings firings;
  const Frame& frame = recorded.frame;
  firings.entry_of_slot.assign(frame.num_slots(), kNoEntry);
  for (std::size_t i = 0; i < frame.num_slots(); ++i) {
    const auto entry = entries.find({frame.x[i], frame.y[i], frame.z[i]});
    if (entry == entries.end()) continue;
    firings.entry_of_slot[i] = entry->second;
    entries.erase(entry);
  }
  firings.recorded = std::move(recorded);
  return firings;
}

// Written by Foxglove's library.
TEST(BagOutput, EditsTheCloudsOfARealBag) {
  const fs::path root = OusterCapture::Path("mcap/pointcloud2");
  if (!exists(root)) GTEST_SKIP() << root << " is not there";
  for (const char* name : {"vls128_pointcloud2_none.mcap", "vls128_pointcloud2_zstd.mcap"}) {
    const TemporaryDirectory folder;
    const auto before = bag::MessagesIn(root / name);
    const auto recording = OpenRecording(root / name);
    const auto output = MakeCopyOutput(root / name, folder.path());
    std::vector<std::vector<std::array<float, 4>>> expected;
    for (std::size_t i = 0; i < before.size(); ++i) {
      auto points = PointsOf(before[i].data);
      const RecordedFirings firings = FiringsOf((*recording->Next())(), points);
      HandEdit edit(firings.recorded);
      std::vector<bool> is_lost(points.size());
      for (std::uint32_t slot = 0; i != 1 && slot < firings.entry_of_slot.size(); slot += 7) {
        const std::uint32_t entry = firings.entry_of_slot[slot];
        if (entry == kNoEntry) continue;
        if (slot % 2 == 0) {
          edit.Remove(slot);
          is_lost[entry] = true;
        } else {
          edit.Weaken(slot, 0.5F);
          points[entry][3] = 0.5F;
        }
      }
      auto& kept = expected.emplace_back();
      for (std::size_t entry = 0; entry < points.size(); ++entry) {
        if (!is_lost[entry]) kept.push_back(points[entry]);
      }
      const auto slots = output->Write(firings, edit.Take());
      ASSERT_TRUE(slots);
      ASSERT_EQ(slots->size(), kept.size());
      for (std::size_t entry = 0; entry < kept.size(); ++entry) {
        const std::uint32_t slot = (*slots)[entry];
        if (slot == kNoSlot) continue;
        ASSERT_EQ(firings.recorded.frame.x[slot], kept[entry][0]);
      }
    }
    output->Finish();
    const auto after = bag::MessagesIn(folder.path() / name);
    ASSERT_EQ(after.size(), before.size());
    for (std::size_t i = 0; i < after.size(); ++i) EXPECT_EQ(PointsOf(after[i].data), expected[i]);
    // Nothing was inserted into the second one.
    EXPECT_TRUE(after[1] == before[1]);
    EXPECT_LT(after[0].data.size(), before[0].data.size());
  }
}

TEST(BagOutput, PutsRowsWhereTheyStandWhateverTheStepOfRowsIs) {
  const std::vector<std::array<float, 4>> points = {{1.0F, 2.0F, 3.0F, 0.0F},
                                                    {4.0F, 5.0F, 6.0F, 0.0F},
                                                    {7.0F, 8.0F, 9.0F, 0.0F},
                                                    {9.0F, 2.0F, 1.0F, 0.0F}};
  ros::PointCloud2 message =
      CloudOf({{1.0F, 2.0F, 3.0F}, {4.0F, 5.0F, 6.0F}, {7.0F, 8.0F, 9.0F}, {9.0F, 2.0F, 1.0F}}, 0);
  message.height = message.width = 2;
  message.row_step = 0;
  MadeBag bag;
  bag.Add("/points", 0, message);
  const fs::path file = bag.Closed();
  const TemporaryDirectory folder;
  const auto output = MakeCopyOutput(file, folder.path());
  const RecordedFirings firings = FiringsOf((*OpenRecording(file)->Next())(), points);
  HandEdit edit(firings.recorded);
  edit.Remove(static_cast<std::uint32_t>(std::ranges::find(firings.recorded.frame.x, 4.0F) -
                                         firings.recorded.frame.x.begin()));
  ASSERT_TRUE(output->Write(firings, edit.Take()));
  output->Finish();
  const auto after = bag::MessagesIn(folder.path() / file.filename());
  const Cloud cloud =
      MakeCloud(ros::FromCdr<ros::PointCloud2>(std::as_bytes(std::span(after.at(0).data))));
  VisitField(cloud, *cloud.Find("x"), [&](std::size_t i, auto value) {
    if (i == 1) {
      EXPECT_TRUE(std::isnan(static_cast<float>(value)));
    } else {
      EXPECT_EQ(static_cast<float>(value), points[i][0]);
    }
  });
}

constexpr std::size_t kNumAlternating = 300;

/// Clouds of so many equal points on one topic, each alone in its chunk: one of "left" and then so
/// many of "right", and so on.
fs::path AlternatingBag(const fs::path& file, std::size_t num_left, std::size_t num_right) {
  const std::vector<std::array<float, 3>> points(kNumAlternating, {1.0F, 2.0F, 3.0F});
  const auto bag = bag::CreateMcap(file, bag::McapCompression::kNone);
  std::int64_t time_ns = 0;
  for (std::size_t i = 0; i < num_left * (1 + num_right); ++i) {
    time_ns += kSecond_ns / 10;
    ros::PointCloud2 cloud = CloudOf(points, time_ns);
    cloud.header.frame_id = i % (1 + num_right) == 0 ? "left" : "right";
    AddMessage(*bag, "/points", time_ns, cloud);
    bag->Commit();
  }
  bag->Close();
  return file;
}

// Else all that was edited would wait in memory for the end.
TEST(BagOutput, WritesOneOfTwoSeriesWhileItIsTold) {
  for (const auto& [series, num_right] :
       {std::pair("left", std::size_t{1}), {"right", 1}, {"left", 3}, {"right", 3}}) {
    SCOPED_TRACE(series + std::to_string(num_right));
    constexpr std::size_t kNumLeft = 16;
    const TemporaryDirectory folder;
    const fs::path file = AlternatingBag(folder.path() / "run.mcap", kNumLeft, num_right);
    const fs::path copy = folder.path() / "out" / "run.mcap";
    fs::create_directories(copy.parent_path());
    const fs::path source = file.string() + ":/points#" + series;
    const auto recording = OpenRecording(source);
    const auto output = MakeCopyOutput(source, copy.parent_path());
    const std::size_t num = series == std::string("left") ? kNumLeft : num_right * kNumLeft;
    for (std::size_t i = 0; i < num; ++i) {
      const RecordedFirings firings =
          FiringsOf((*recording->Next())(),
                    std::vector<std::array<float, 4>>(kNumAlternating, {1.0F, 2.0F, 3.0F, 0.0F}));
      HandEdit edit(firings.recorded);
      edit.Remove(static_cast<std::uint32_t>(std::ranges::find(firings.recorded.frame.x, 1.0F) -
                                             firings.recorded.frame.x.begin()));
      ASSERT_TRUE(output->Write(firings, edit.Take()));
      if (2 * (i + 1) != num) continue;
      const auto written =
          static_cast<double>(fs::file_size(copy.string() + std::string(kUnfinishedSuffix)));
      // All up to this message, of which up to three of the other series follow, and what stands
      // behind the messages at the end: less than a tenth.
      EXPECT_NEAR(written / static_cast<double>(fs::file_size(file)), 0.5, 0.1);
    }
    output->Finish();
    const auto before = bag::MessagesIn(file);
    const auto after = bag::MessagesIn(copy);
    ASSERT_EQ(after.size(), before.size());
    for (std::size_t i = 0; i < before.size(); ++i) {
      const bool is_left = i % (1 + num_right) == 0;
      EXPECT_EQ(after[i] == before[i], is_left != (series == std::string("left"))) << i;
    }
  }
}

// By the check as by the run, which leaves no folder behind.
TEST(BagOutput, RefusesCloudsOfLivox) {
  for (const std::string_view type :
       {ros::LivoxCloud::kName, ros::LivoxCloud::kOlderNames[0], ros::LivoxCloud::kOlderNames[1]}) {
    MadeBag bag;
    const ros::LivoxCloud cloud = {
        .header = {{}, "livox"}, .point_num = 1, .points = {{0, 1.0F, 2.0F, 3.0F, 200, 0, 1}}};
    bag.Add("/livox", 0, cloud, type);
    const fs::path file = bag.Closed();
    const TemporaryDirectory folder;
    const std::string refusal = file.string() +
                                ": must have clouds of type sensor_msgs/msg/PointCloud2 or packets "
                                "to be inserted into (got " +
                                std::string(type) + ")";
    EXPECT_EQ(MessageOf([&] { (void)MakeCopyOutput(file, folder.path()); }), refusal);
    const InsertChoices choices = {
        .recording = file,
        .plan = WritePlan(folder.path(), R"({"poses": "standing"})", "", VelodyneOfPlan()),
        .directory = folder.path() / "out",
        .may_use_points_alone = true};
    const InsertPlan plan = ReadInsertPlan(choices.plan, file);
    EXPECT_EQ(MessageOf([&] { (void)CheckInsert(choices, plan); }), refusal);
    EXPECT_EQ(MessageOf([&] {
                (void)RunInsert(choices, plan,
                                {[](std::uint32_t, std::uint32_t) {}, [] { return false; }});
              }),
              refusal);
    EXPECT_FALSE(exists(choices.directory));
  }
}

}  // namespace
}  // namespace railcast
