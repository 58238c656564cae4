#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <future>
#include <map>
#include <string>
#include <vector>

#include "core/extras/ros/bag/bag.h"
#include "core/extras/ros/messages/cdr.h"
#include "core/extras/ros/messages/geometry_messages.h"
#include "core/extras/ros/messages/message_type.h"
#include "core/extras/ros/messages/point_layout.h"
#include "core/extras/ros/messages/sensor_messages.h"
#include "core/io/stream/stream_encoder.h"
#include "tests/core/extras/dds/fast_dds.h"
#include "tests/core/extras/dds/free_domain.h"
#include "tests/core/extras/ros/bag/read_bag.h"
#include "tests/core/io/recording/read_all.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/live/live_process.h"

// What `replay` sends to ROS 2, as Fast DDS receives it.

namespace railcast {
namespace {

namespace fs = std::filesystem;

/// A replay to a domain of its own, whose frames wait for steps.
class SteppedReplay {
 public:
  explicit SteppedReplay(const std::string& arguments)
      : controller_(port_), run_(std::async(std::launch::async, [arguments, this] {
          return GenerateLive("replay " + arguments + " --domain " + std::to_string(domain) +
                              " --lockstep --pacing burst --commands-port " + port_);
        })) {}

  void Step() {
    EXPECT_THAT(controller_.Say(R"({"command":"step"})"), testing::HasSubstr(R"("ok":true)"));
  }
  [[nodiscard]] Ended Wait() { return run_.get(); }

  const std::uint32_t domain = FreeDomain();

 private:
  const std::string port_ = FreePort();
  Controller controller_;
  std::future<Ended> run_;
};

fs::path MadeRecording(const TemporaryDirectory& folder,
                       std::size_t num_frames,
                       const std::string& options) {
  const fs::path out = folder.path() / "out";
  const Ended ended =
      Generate("sequence " + CoarseScenario(folder.path()) + " --frames " +
               std::to_string(num_frames) + " --out " + out.string() + " " + options);
  EXPECT_EQ(ended.status, 0) << ended.said;
  return out;
}

bool IsSame(const MessageBytes& got, const std::string& sent) {
  const MessageBytes bytes = WithoutPadding(got, sent.size());
  return std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()) == sent;
}

TEST(Ros2Replay, BringsTheMessagesOfABagByteForByte) {
  const TemporaryDirectory folder;
  constexpr std::size_t kNumFrames = 4;
  const fs::path bag = MadeRecording(folder, kNumFrames, "--format mcap") / "frames.mcap";
  std::map<std::string, std::vector<std::string>> recorded;
  for (bag::HeldMessage& message : bag::MessagesIn(bag)) {
    recorded["rt" + message.topic].push_back(std::move(message.data));
  }
  SteppedReplay replay(bag.string());
  FastParticipant other(replay.domain);
  std::map<std::string, FastReader*> readers;
  const auto topics = bag::OpenBag(bag)->topics();
  // Who sends a late reader what is latched knows of all that were made before it.
  for (const bool is_latched : {false, true}) {
    for (const bag::BagTopic& topic : topics) {
      const std::string name = "rt" + topic.name;
      if (topic.is_latched != is_latched || !recorded.contains(name)) continue;
      readers[name] = &other.Read(name, ros::DdsName(topic.type), is_latched);
      const SeenWriter writer = other.WaitForWriter(name);
      EXPECT_EQ(writer.type, ros::DdsName(topic.type));
      EXPECT_EQ(writer.user_data, "typehash=" + topic.hash + ";");
      EXPECT_EQ(writer.is_latched, is_latched);
    }
  }
  EXPECT_GE(readers.size(), 6U);
  replay.Step();
  for (const bag::BagTopic& topic : topics) {
    if (!topic.is_latched) continue;
    const std::string name = "rt" + topic.name;
    const auto got = readers.at(name)->WaitFor(1);
    ASSERT_EQ(got.size(), 1U);
    EXPECT_TRUE(IsSame(got[0], recorded.at(name).at(0))) << name;
  }
  for (std::size_t i = 1; i < kNumFrames; ++i) {
    replay.Step();
    for (const bag::BagTopic& topic : topics) {
      const std::string name = "rt" + topic.name;
      if (topic.is_latched || !recorded.contains(name)) continue;
      // A transform follows the last frame.
      const std::vector<std::string>& all = recorded.at(name);
      const std::string& sent = i + 1 == kNumFrames ? all.back() : all.at(i);
      FastReader& reader = *readers.at(name);
      const auto has_come = [&] {
        const auto got = reader.WaitFor(0);
        return !got.empty() && IsSame(got.back(), sent);
      };
      EXPECT_TRUE(WaitUntilTrue(has_come)) << name << i;
    }
  }
  const Ended ended = replay.Wait();
  EXPECT_EQ(ended.status, 0) << ended.said;
  EXPECT_THAT(ended.said, testing::HasSubstr("frames.mcap: " + std::to_string(topics.size()) +
                                             " topics in domain "));
}

TEST(Ros2Replay, PublishesTheFramesOfASequence) {
  const TemporaryDirectory folder;
  constexpr std::size_t kNumFrames = 12;
  const fs::path run = MadeRecording(folder, kNumFrames, "");
  const auto frames = ReadAll(run);
  SteppedReplay replay(run.string() + " --protocol ros2");
  FastParticipant other(replay.domain);
  FastReader& poses = other.Read("rt/tf", ros::TypeOf<ros::TfMessage>().dds_name);
  FastReader& clouds = other.Read("rt/coarse/points", ros::TypeOf<ros::PointCloud2>().dds_name);
  ASSERT_TRUE(poses.WaitForWriter());
  ASSERT_TRUE(clouds.WaitForWriter());
  std::size_t num_got = 0;
  for (std::size_t i = 0; i < kNumFrames; ++i) {
    replay.Step();
    // The writers may know of the readers some time after these know of them.
    constexpr int kMeanwhile_ms = 500;
    const auto got = clouds.WaitFor(num_got + 1, num_got == 0 ? kMeanwhile_ms : kDdsPatience_ms);
    if (got.empty()) continue;
    ASSERT_EQ(got.size(), ++num_got);
    const Frame& frame = frames[i].frame;
    const auto expected =
        ros::MakeCloud(frame, {ros::PointLayout::kRailcast, StreamSpec{}.fields}, "coarse");
    EXPECT_TRUE(ros::FromCdr<ros::PointCloud2>(got.back()) == expected);
    ros::TransformStamped pose;
    EXPECT_TRUE(WaitUntilTrue([&] {
      const auto got_poses = poses.WaitFor(0);
      if (!got_poses.empty()) {
        pose = ros::FromCdr<ros::TfMessage>(got_poses.back()).transforms.at(0);
      }
      return pose.header.stamp == expected.header.stamp;
    }));
    EXPECT_EQ(pose.header.frame_id, "map");
    EXPECT_EQ(pose.child_frame_id, "coarse");
    EXPECT_EQ(pose.transform.translation.x, frame.world_from_sensor.translation().x());
  }
  EXPECT_GE(num_got, 2U);
  EXPECT_EQ(replay.Wait().status, 0);
}

}  // namespace
}  // namespace railcast
