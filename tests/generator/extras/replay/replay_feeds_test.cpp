#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "core/extras/packets/pcap/pcap_writer.h"
#include "core/extras/ros/bag/bag.h"
#include "core/extras/ros/messages/cdr.h"
#include "core/extras/ros/messages/sensor_messages.h"
#include "generator/extras/replay/frame_feeds.h"
#include "generator/extras/replay/message_feed.h"
#include "generator/extras/replay/packet_feed.h"
#include "generator/extras/replay/replay_feed.h"
#include "tests/core/extras/packets/hesai/made_packet.h"
#include "tests/core/extras/ros/bag/read_bag.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/recording/made_sequence.h"
#include "tests/core/io/temporary_directory.h"

namespace railcast {
namespace {

constexpr std::int64_t kMs_ns = 1'000'000;
const std::vector<Endpoint> kNowhere = {ParseEndpoint("127.0.0.1:9", 0)};

/// When the datagrams of each frame are due, in ms.
std::vector<std::vector<std::int64_t>> DueMsOf(ReplayFeed& feed) {
  std::vector<std::vector<std::int64_t>> frames;
  Datagrams datagrams;
  for (; feed.Load(); datagrams.Clear()) {
    feed.Take(datagrams);
    auto& frame = frames.emplace_back();
    for (const Datagrams::Item& item : datagrams.items) frame.push_back(item.due_ns / kMs_ns);
    EXPECT_EQ(frame.front(), feed.begin_ns() / kMs_ns);
  }
  return frames;
}

/// A capture of packets of a Pandar64, each a turn of its own, at these times.
PacketRecording PacketsAt(const std::vector<std::int64_t>& times_ms,
                          const TemporaryDirectory& folder) {
  Datagrams datagrams;
  for (const std::int64_t ms : times_ms) {
    const auto packet = NumberedPacket(static_cast<std::uint32_t>(datagrams.items.size()));
    datagrams.items.push_back({.offset = datagrams.bytes.size(),
                               .size = static_cast<std::uint32_t>(packet.size()),
                               .due_ns = ms * kMs_ns});
    datagrams.bytes.insert(datagrams.bytes.end(), packet.begin(), packet.end());
  }
  const std::filesystem::path file = folder.path() / "a.pcap";
  PcapWriter writer(file, 2368, 8308);
  writer.Write(datagrams, datagrams.items);
  writer.Finish();
  return PacketRecording(*FindCapture(file));
}

using Frames = std::vector<std::vector<std::int64_t>>;

TEST(PacketFeed, KeepsTheSpacingsOfTheCapture) {
  const TemporaryDirectory folder;
  PacketFeed feed(PacketsAt({500, 510, 530, 560}, folder), kNowhere, 1.0, {});
  // A turn ends with the first packet of the next one.
  EXPECT_EQ(DueMsOf(feed), (Frames{{0, 10}, {30}, {60}}));
  PacketFeed faster(PacketsAt({500, 510, 530, 560}, folder), kNowhere, 10.0, {});
  EXPECT_EQ(DueMsOf(faster), (Frames{{0, 1}, {3}, {6}}));
}

TEST(PacketFeed, EndsFramesAtPausesAndReplaysThose) {
  const TemporaryDirectory folder;
  PacketFeed feed(PacketsAt({0, 1'500, 61'500}, folder), kNowhere, 1.0, {});
  EXPECT_EQ(DueMsOf(feed), (Frames{{0}, {1'500}, {61'500}}));
}

TEST(PacketFeed, SendsThoseFramesThatAreWanted) {
  const TemporaryDirectory folder;
  const std::vector<std::int64_t> times_ms = {0, 10, 20, 30, 40};
  PacketFeed feed(PacketsAt(times_ms, folder), kNowhere, 1.0, {.start = 1, .count = 2});
  EXPECT_EQ(DueMsOf(feed), (Frames{{0}, {10}}));
  EXPECT_EQ(
      MessageOf([&] {
        PacketFeed none(PacketsAt(times_ms, folder), kNowhere, 1.0, {.start = 4, .count = {}});
      }),
      "--start-frame: must be the number of a frame of " + (folder.path() / "a.pcap").string() +
          " (got 4)");
}

TEST(PacketFeed, SaysWhereThePacketsGo) {
  const TemporaryDirectory folder;
  const PacketFeed there(PacketsAt({0, 1}, folder), kNowhere, 1.0, {});
  EXPECT_EQ(there.Description(), "Pandar64: packets to 127.0.0.1:9");
  const PacketFeed as_recorded(PacketsAt({0, 1}, folder), {ParseEndpoint("127.0.0.1", 0)}, 1.0, {});
  EXPECT_EQ(as_recorded.Description(), "Pandar64: packets to 127.0.0.1:2368");
}

/// A bag with messages of a latched topic, of clouds and of something that is not of ROS.
class MadeMessages {
 public:
  /// @param last_ms Time of the last message, which holds no points.
  explicit MadeMessages(std::int64_t last_ms = 5'000) : writer_(bag::CreateMcap(file())) {
    bag::BagTopic other = bag::TopicNamed("/other");
    other.encoding = "json";
    topics_ = {writer_->Add(bag::TopicNamed("/map", true)), writer_->Add(bag::TopicNamed("said")),
               writer_->Add({.name = "/points",
                             .type = std::string(ros::PointCloud2::kName),
                             .definition = {},
                             .hash = {}}),
               writer_->Add(other)};
    Write(0, 0, "m");
    Write(1, 10, "a");
    Write(2, 20, "P");
    Write(3, 25, "j");
    Write(1, 30, "b");
    Write(2, 40, "Q");
    Write(1, last_ms, "c");
    writer_->Close();
  }
  [[nodiscard]] std::filesystem::path file() const { return folder_.path() / "run.mcap"; }

 private:
  void Write(std::size_t topic, std::int64_t ms, const std::string& text) {
    bag::WriteText(*writer_, topics_[topic], ms * kMs_ns, text);
  }

  TemporaryDirectory folder_;
  std::unique_ptr<bag::BagWriter> writer_;
  std::vector<std::size_t> topics_;
};

/// The bytes of each frame's messages, one after the other.
std::vector<std::string> TextsOf(ReplayFeed& feed) {
  std::vector<std::string> frames;
  Datagrams datagrams;
  for (; feed.Load(); datagrams.Clear()) {
    feed.Take(datagrams);
    frames.emplace_back(datagrams.bytes.begin(), datagrams.bytes.end());
  }
  return frames;
}

TEST(MessageFeed, SendsTheBytesOfAllTopicsUpToEachCloud) {
  const MadeMessages bag;
  MessageFeed feed(bag.file(), "", 2.0, {});
  EXPECT_EQ(TextsOf(feed), (std::vector<std::string>{"maP", "bQ", "c"}));
  EXPECT_EQ(feed.LeftOut(), "topics that are not of ROS 2: /other");
  MessageFeed again(bag.file(), "", 2.0, {});
  EXPECT_EQ(DueMsOf(again), (Frames{{0, 5, 10}, {15, 20}, {2'500}}));
}

TEST(MessageFeed, SendsWhatFollowsTheLastCloudWithinASecondWithItsFrame) {
  const MadeMessages bag(1'040);
  MessageFeed feed(bag.file(), "", 1.0, {});
  EXPECT_EQ(TextsOf(feed), (std::vector<std::string>{"maP", "bQc"}));
  const MadeMessages later(1'041);
  MessageFeed other(later.file(), "", 1.0, {});
  EXPECT_EQ(TextsOf(other), (std::vector<std::string>{"maP", "bQ", "c"}));
}

TEST(MessageFeed, SendsWhatIsLatchedOfFramesThatAreLeftOut) {
  const MadeMessages bag;
  MessageFeed feed(bag.file(), "", 1.0, {.start = 1, .count = 1});
  EXPECT_EQ(TextsOf(feed), (std::vector<std::string>{"mbQ"}));
}

TEST(MessageFeed, SendsASingleTopicIfToldSo) {
  const MadeMessages bag;
  MessageFeed feed(bag.file(), "/said", 1.0, {});
  EXPECT_EQ(TextsOf(feed), (std::vector<std::string>{"a", "b", "c"}));
  EXPECT_EQ(feed.LeftOut(), "");
  EXPECT_EQ(MessageOf([&] { MessageFeed none(bag.file(), "/other", 1.0, {}); }),
            bag.file().string() + ": --topic: must be one of /map, said, /points (got /other)");
  EXPECT_EQ(MessageOf([&] { MessageFeed none(bag.file(), "", 1.0, {.start = 9, .count = {}}); }),
            "--start-frame: must be the number of a frame of " + bag.file().string() + " (got 9)");
}

TEST(MessageFeed, RefusesABagWithoutMessages) {
  const TemporaryDirectory folder;
  const std::filesystem::path file = folder.path() / "empty.mcap";
  auto writer = bag::CreateMcap(file);
  static_cast<void>(writer->Add(bag::TopicNamed("/said")));
  writer->Close();
  EXPECT_EQ(MessageOf([&] { MessageFeed none(file, "", 1.0, {}); }),
            file.string() + ": must hold a frame (got none)");
}

/// Clouds of railcast beside each other, without stamps.
std::filesystem::path CloudsWithoutStamps(const TemporaryDirectory& folder) {
  const std::filesystem::path run = folder.path() / "run";
  static_cast<void>(MakeSequence(run, {.num_frames = 3}));
  return run / "frames";
}

TEST(FrameSource, NeedsARateForCloudsWithoutStamps) {
  const TemporaryDirectory folder;
  const auto clouds = CloudsWithoutStamps(folder);
  FrameSource without(OpenRecording(clouds), {});
  EXPECT_EQ(MessageOf([&] { static_cast<void>(without.Load()); }),
            (clouds / "000001.pcd").string() +
                ": stamp: must differ from that of the frame before, or --rate-hz must say how "
                "many frames a second there are (got 0 ns)");
  FrameSource source(OpenRecording(clouds), {.rate_hz = 20.0, .frames = {}});
  for (const std::int64_t ms : {0, 50, 100}) {
    ASSERT_TRUE(source.Load());
    EXPECT_EQ(source.begin_ns(), ms * kMs_ns);
    EXPECT_EQ(source.StampedFrame().frame.stamp_ns, ms * kMs_ns);
  }
  EXPECT_FALSE(source.Load());
}

TEST(FrameSource, StatesTheTimeOfDayIfToldSo) {
  const TemporaryDirectory folder;
  static_cast<void>(MakeSequence(folder.path() / "run", {.start_frame = 4, .num_frames = 2}));
  FrameSource source(OpenRecording(folder.path() / "run"), {});
  constexpr std::int64_t kNow_ns = 1'795'000'000'000'000'000;
  source.SetClock(kNow_ns);
  ASSERT_TRUE(source.Load());
  EXPECT_EQ(source.begin_ns(), 0);
  EXPECT_EQ(source.StampedFrame().frame.stamp_ns, kNow_ns);
  EXPECT_EQ(source.StampedFrame().frame.index, 4U);
  ASSERT_TRUE(source.Load());
  EXPECT_EQ(source.StampedFrame().frame.stamp_ns, kNow_ns + source.begin_ns());
}

TEST(FrameSource, HoldsWhatIsWholeOfADamagedSequence) {
  const TemporaryDirectory folder;
  const std::filesystem::path run = folder.path() / "run";
  static_cast<void>(MakeSequence(run, {.num_frames = 3}));
  std::filesystem::resize_file(run / "frames/000002.pcd", 1'000);
  FrameSource source(OpenRecording(run), {});
  EXPECT_TRUE(source.Load());
  EXPECT_TRUE(source.Load());
  EXPECT_EQ(source.StampedFrame().frame.index, 1U);
  EXPECT_THAT(MessageOf([&] { static_cast<void>(source.Load()); }),
              testing::StartsWith((run / "frames/000002.pcd").string() + ": "));
}

TEST(FrameFeeds, SendTheFieldsThatTheRecordingHas) {
  const TemporaryDirectory folder;
  static_cast<void>(
      MakeSequence(folder.path() / "run", {.fields = "x,y,z,ring,label", .num_frames = 1}));
  const FrameSource source(OpenRecording(folder.path() / "run"), {});
  EXPECT_EQ(FieldsOf(source.first(), std::nullopt).Text(), "x,y,z,ring,label");
  EXPECT_EQ(FieldsOf(source.first(), FieldSelection("label,x")).Text(), "x,label");
  EXPECT_THAT(FieldsOf(source.first(), FieldSelection("all")).Text(),
              testing::MatchesRegex("x,y,z,range_m,.*ring.*label"));
  EXPECT_THAT(
      MessageOf([&] { static_cast<void>(FieldsOf(source.first(), FieldSelection("x,material"))); }),
      testing::MatchesRegex("--fields: must be among those of the recording, x,y,z,.*"
                            "label.* \\(got material\\)"));
}

constexpr std::int64_t kMilli_ns = 1'000'000;
constexpr std::int64_t kBegin_ns = 1'700'000'000'000'000'000;

TEST(ReplayTimes, PassAsRecordedOrFaster) {
  for (const double rate : {1.0, 4.0, 0.5}) {
    ReplayTimes times(rate);
    for (const std::int64_t ms : {0, 1, 100, 3'600'000}) {
      EXPECT_EQ(static_cast<double>(times.Of(kBegin_ns + ms * kMilli_ns)) * rate,
                static_cast<double>(ms * kMilli_ns));
    }
    EXPECT_EQ(static_cast<double>(times.Lasting(8 * kMilli_ns)) * rate, 8e6);
  }
}

TEST(ReplayTimes, SendWhatWasOvertakenAtOnce) {
  ReplayTimes times(1.0);
  EXPECT_EQ(times.Of(kBegin_ns), 0);
  EXPECT_EQ(times.Of(kBegin_ns + 10 * kMilli_ns), 10 * kMilli_ns);
  EXPECT_EQ(times.Of(kBegin_ns + 7 * kMilli_ns), 10 * kMilli_ns);
  EXPECT_EQ(times.Of(kBegin_ns + 9 * kMilli_ns), 10 * kMilli_ns);
  EXPECT_EQ(times.Of(kBegin_ns + 11 * kMilli_ns), 11 * kMilli_ns);
}

TEST(ReplayTimes, GoOnFromWhereAClockWasSetBack) {
  ReplayTimes times(2.0);
  EXPECT_EQ(times.Of(kBegin_ns), 0);
  EXPECT_EQ(times.Of(kBegin_ns + 10 * kMilli_ns), 5 * kMilli_ns);
  EXPECT_EQ(times.Of(kBegin_ns - 5'000 * kMilli_ns), 5 * kMilli_ns);
  EXPECT_EQ(times.Of(kBegin_ns - 4'996 * kMilli_ns), 7 * kMilli_ns);
}

TEST(ReplayTimes, StandAnyTime) {
  ReplayTimes times(1e-3);
  EXPECT_EQ(times.Of(std::numeric_limits<std::int64_t>::min()), 0);
  // That far is further than numbers can say, so it counts as a clock that was set.
  EXPECT_EQ(times.Of(std::numeric_limits<std::int64_t>::max()), 0);
  EXPECT_EQ(times.Of(0), 0);
  std::int64_t last_ns = 0;
  for (int i = 0; i < 3; ++i) {
    EXPECT_GE(times.Of(std::numeric_limits<std::int64_t>::max() / 2), last_ns);
    last_ns = times.Of(std::numeric_limits<std::int64_t>::max() / 2);
    static_cast<void>(times.Of(0));
  }
}

}  // namespace
}  // namespace railcast
