#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "core/extras/ros/messages/cdr.h"
#include "core/extras/ros/messages/frame_topics.h"
#include "core/extras/ros/messages/geometry_messages.h"
#include "core/extras/ros/messages/sensor_messages.h"
#include "core/io/write_file.h"
#include "generator/extras/ros/run_topics.h"
#include "generator/run/frame_maker.h"
#include "tests/core/extras/dds/fast_dds.h"
#include "tests/core/extras/dds/free_domain.h"
#include "tests/core/io/temporary_directory.h"
#include "tests/generator/live/live_process.h"
#include "tests/support/exits_with.h"

// What `stream` sends to ROS 2, as Fast DDS receives it, and the commands that Fast DDS gives.

namespace railcast {
namespace {

constexpr const char* kPoints = "rt/coarse/points";
constexpr const char* kTwistType = "geometry_msgs::msg::dds_::TwistStamped_";

const std::string kCloudType = ros::TypeOf<ros::PointCloud2>().dds_name;
const std::string kOdometryType = ros::TypeOf<ros::Odometry>().dds_name;

std::string RosArguments(const std::string& scenario, std::uint32_t domain) {
  return scenario + " --protocol ros2 --domain " + std::to_string(domain);
}

ros::FrameTopics TopicsOfSensor(const FrameMaker& maker) {
  return ros::FrameTopics(
      TopicsSpecOf(maker.scenario(), *maker.StateAt(0).world, {}, ros::ImageEncoding::kJpeg));
}

/// All messages of the first frames of a scenario's only sensor, by topic, as they go into files.
std::map<std::string, std::vector<MessageBytes>> MessagesOfFrames(const std::string& scenario,
                                                                  std::uint32_t num_frames) {
  FrameMaker maker(ReadScenario(scenario), 0);
  const ros::FrameTopics topics = TopicsOfSensor(maker);
  std::map<std::string, std::vector<MessageBytes>> messages;
  const auto add = [&](std::vector<ros::TopicMessage> some) {
    for (ros::TopicMessage& message : some) {
      messages["rt" + topics.topics()[message.topic].name].push_back(std::move(message.cdr));
    }
  };
  add(topics.First(0));
  for (std::uint32_t i = 0; i < num_frames; ++i) {
    MadeFrame made;
    maker.Begin(0, i)(made);
    add(MessagesOf(topics, 0, made));
  }
  return messages;
}

void ExpectSame(const std::vector<MessageBytes>& sent, const std::vector<MessageBytes>& got) {
  ASSERT_EQ(got.size(), sent.size());
  for (std::size_t i = 0; i < got.size(); ++i) {
    EXPECT_EQ(WithoutPadding(got[i], sent[i].size()), sent[i]) << i;
  }
}

TEST(Ros2Stream, BringsEveryMessageOfEveryFrameToFastDds) {
  const TemporaryDirectory folder;
  const std::string scenario = CoarseScenario(folder.path());
  const std::uint32_t domain = FreeDomain();
  const std::string commands_port = FreePort();
  constexpr std::uint32_t kNumFrames = 12;
  Stream stream(RosArguments(scenario, domain) +
                " --fields all --lockstep --pacing burst --duration 0.6" + " --commands-port " +
                commands_port);
  const auto sent = MessagesOfFrames(scenario, kNumFrames);
  const ros::FrameTopics topics = [&] {
    const FrameMaker maker(ReadScenario(scenario), 0);
    return TopicsOfSensor(maker);
  }();
  FastParticipant other(domain);
  std::map<std::string, FastReader*> readers;
  // Readers are told of in the order in which they are made: who sends a late one what is latched
  // knows all others, too.
  for (const bool is_latched : {false, true}) {
    for (const ros::Topic& topic : topics.topics()) {
      if (topic.is_latched != is_latched) continue;
      readers["rt" + topic.name] = &other.Read("rt" + topic.name, topic.type.dds_name, is_latched);
    }
  }
  for (const ros::Topic& topic : topics.topics()) {
    if (!topic.is_latched) continue;
    ASSERT_EQ(readers.at("rt" + topic.name)->WaitFor(1).size(), 1U);
  }
  Controller controller(commands_port);
  for (std::uint32_t i = 0; i < kNumFrames; ++i) {
    EXPECT_NE(controller.Say(R"({"command":"step"})").find("\"ok\":true"), std::string::npos);
  }
  EXPECT_THAT(stream.Wait(), ExitsWith(0, testing::HasSubstr("coarse: 12 frames, 0 late; ")));
  for (const auto& [name, reader] : readers) {
    SCOPED_TRACE(name);
    ExpectSame(sent.at(name), reader->WaitFor(sent.at(name).size(), /*timeout_ms=*/1000));
  }
}

TEST(Ros2Stream, GivesLateJoinersTheStaticTransforms) {
  const TemporaryDirectory folder;
  const std::string scenario = CoarseScenario(folder.path());
  const std::uint32_t domain = FreeDomain();
  const std::string commands_port = FreePort();
  Stream stream(RosArguments(scenario, domain) + " --lockstep --pacing burst --duration 0.2" +
                " --commands-port " + commands_port);
  Controller controller(commands_port);
  const auto step = [&] {
    EXPECT_NE(controller.Say(R"({"command":"step"})").find("\"ok\":true"), std::string::npos);
  };
  step();
  step();
  FastParticipant other(domain);
  FastReader& transforms = other.Read("rt/tf_static", ros::TypeOf<ros::TfMessage>().dds_name, true);
  const auto got = transforms.WaitFor(1);
  ASSERT_EQ(got.size(), 1U);
  const auto message = ros::FromCdr<ros::TfMessage>(got.front());
  ASSERT_EQ(message.transforms.size(), 1U);
  EXPECT_EQ(message.transforms[0].header.frame_id, "base_link");
  EXPECT_EQ(message.transforms[0].child_frame_id, "coarse");
  EXPECT_EQ(message.transforms[0].transform.translation.x, 1.0);
  EXPECT_EQ(message.transforms[0].transform.translation.z, 2.5);
  step();
  step();
  EXPECT_EQ(stream.Wait().status, 0);
}

/// The coarse scenario with brakes of 2 m/s^2 at commands of ROS 2, begun at a station.
std::string FirmBrakes(const std::filesystem::path& folder, int start_s_m = 200) {
  std::string text = ReadFileWhole(CoarseScenario(folder));
  const auto replace = [&](const std::string& what, const std::string& with) {
    text.replace(text.find(what), what.size(), with);
  };
  replace(R"("version": 1,)", R"("version": 1, "interfaces": {"ros2": {"deceleration_mps2": 2}},)");
  replace(R"("start_s_m": 200)", R"("start_s_m": )" + std::to_string(start_s_m));
  const std::filesystem::path file = folder / "firm.json";
  WriteFileWhole(file, text);
  return file.string();
}

/// The distance ahead of the vehicle's front of the nearest point within the vehicle's outline.
double NearestAhead_m(const ros::PointCloud2& cloud) {
  double nearest_m = std::numeric_limits<double>::infinity();
  const auto offset_of = [&](const std::string& name) {
    const auto found = std::find_if(cloud.fields.begin(), cloud.fields.end(),
                                    [&](const auto& field) { return field.name == name; });
    return found->offset;
  };
  for (std::size_t at = 0; at < cloud.data.size(); at += cloud.point_step) {
    const auto value_of = [&](const std::string& name) {
      float value = 0;
      std::memcpy(&value, &cloud.data[at + offset_of(name)], sizeof value);
      return value;
    };
    const float x = value_of("x"), y = value_of("y"), z = value_of("z");
    if (x > 1.0F && std::abs(y) < 1.4F && z > 0.4F && z < 4.0F) {
      nearest_m = std::min<double>(nearest_m, x);
    }
  }
  return nearest_m;
}

// The loop of examples/brake_client.py by messages alone: the cloud in, the brake out.
TEST(Ros2Stream, LetsANodeBrakeForTheWagonAhead) {
  const TemporaryDirectory folder;
  // Four seconds before the wagon is near: a writer knows of its reader before the reader knows of
  // it, and what is written between is lost.
  const std::string scenario = FirmBrakes(folder.path(), 160);
  const std::uint32_t domain = FreeDomain();
  const std::filesystem::path log = folder.path() / "log.jsonl";
  Stream stream(RosArguments(scenario, domain) +
                " --pacing burst --duration 12 --commands-topic /brake --commands-log " +
                log.string());
  FastParticipant node(domain);
  FastReader& clouds = node.Read(kPoints, kCloudType);
  FastReader& motion = node.Read("rt/odometry", kOdometryType);
  auto& brake = node.Write("rt/brake", kTwistType);
  ASSERT_TRUE(WaitForReader(brake));
  std::size_t seen = 0;
  double ahead_m = std::numeric_limits<double>::infinity();
  while (ahead_m > 42.0) {
    const auto got = clouds.WaitFor(++seen);
    ASSERT_GE(got.size(), seen);
    ahead_m = NearestAhead_m(ros::FromCdr<ros::PointCloud2>(got[seen - 1]));
  }
  EXPECT_GT(ahead_m, 30.0);
  MessageBytes to_standstill = ros::ToCdr(ros::TwistStamped{});
  MessageBytes too_short(to_standstill.begin(), to_standstill.end() - 8);
  MessageBytes hostile = {std::byte{0}, std::byte{1}, std::byte{0}, std::byte{0}};
  hostile.resize(300, std::byte{0xFF});
  for (MessageBytes* message : {&too_short, &hostile, &to_standstill}) {
    EXPECT_TRUE(brake.write(message));
  }
  EXPECT_THAT(
      stream.Wait(),
      ExitsWith(0, testing::HasSubstr("commands on /brake: 1 done, 2 refused; the last one: "
                                      "geometry_msgs/msg/TwistStamped: ")));
  const std::string command = ReadFileWhole(log);
  EXPECT_NE(command.find(R"({"command":"brake","deceleration_mps2":2.0})"), std::string::npos)
      << command;
  const auto poses = motion.WaitFor(1);
  const auto first = ros::FromCdr<ros::Odometry>(poses.front());
  const auto last = ros::FromCdr<ros::Odometry>(poses.back());
  EXPECT_NEAR(first.twist.twist.linear.x, 10.0, 1e-3);
  EXPECT_NEAR(last.twist.twist.linear.x, 0.0, 1e-9);
  const double gap_m = NearestAhead_m(ros::FromCdr<ros::PointCloud2>(clouds.WaitFor(seen).back()));
  EXPECT_GT(gap_m, 5.0);
  EXPECT_LT(gap_m, ahead_m - 24.0);
}

MessageBytes StepAt(std::int32_t sec, std::uint32_t nanosec = 0) {
  return ros::ToCdr(ros::Time{sec, nanosec});
}

TEST(Ros2Stream, WaitsForTheStampOfEachFrameOnAStepTopic) {
  const TemporaryDirectory folder;
  const std::string scenario = CoarseScenario(folder.path());
  const std::uint32_t domain = FreeDomain();
  const std::string commands_port = FreePort();
  Stream stream(RosArguments(scenario, domain) +
                " --lockstep --step-topic /step --pacing burst --duration 0.3 --commands-port " +
                commands_port);
  FastParticipant node(domain);
  auto& steps = node.Write("rt/step", ros::TypeOf<ros::Time>().dds_name);
  const auto say = [&](MessageBytes message) { EXPECT_TRUE(steps.write(&message)); };
  constexpr int kWhile_ms = 300;
  // Nothing comes before somebody reads, and then once, however often it is asked for.
  std::this_thread::sleep_for(std::chrono::milliseconds(kWhile_ms));
  say(StepAt(-1));
  FastReader& clouds = node.Read(kPoints, kCloudType);
  ASSERT_TRUE(WaitUntilTrue([&] {
    say(StepAt(-1));
    return !clouds.WaitFor(1, kWhile_ms).empty();
  }));
  say(StepAt(-1));
  EXPECT_EQ(clouds.WaitFor(2, kWhile_ms).size(), 1U);
  // The stamps of 20 Hz.
  say(StepAt(0));
  EXPECT_EQ(clouds.WaitFor(2).size(), 2U);
  say(StepAt(0));
  say(StepAt(0, 49'999'999));
  say(MessageBytes(7, std::byte{1}));
  EXPECT_EQ(clouds.WaitFor(3, kWhile_ms).size(), 2U);
  EXPECT_THAT(Controller(commands_port).Say(R"({"command":"step"})"),
              testing::HasSubstr("command: step must come on the topic of --step-topic, for which "
                                 "this run waits"));
  say(StepAt(0, 50'000'000));
  EXPECT_EQ(clouds.WaitFor(4, kWhile_ms).size(), 3U);
  // All that are left.
  say(StepAt(10));
  const Ended ended = stream.Wait();
  EXPECT_EQ(ended.status, 0) << ended.said;
  EXPECT_EQ(clouds.WaitFor(6).size(), 6U);
  EXPECT_THAT(ended.said, testing::HasSubstr("coarse: 6 frames, 0 late; "));
  EXPECT_THAT(
      ended.said,
      testing::HasSubstr("steps on /step: 1 refused; the last one: builtin_interfaces/msg/Time: "));
}

// The example is run as it is, where rclpy is not: what stands in for it speaks by Fast DDS, too.
TEST(Ros2Stream, IsDrivenByTheNodeThatBrakesAsByTheClient) {
  const TemporaryDirectory folder;
  const std::string scenario = FirmBrakes(folder.path());
  const std::string domain = std::to_string(FreeDomain());
  const std::string frames_port = FreePort();
  const std::string commands_port = FreePort();
  const auto report_of = [&](const std::string& stream, const std::string& driver) {
    const Ended ended = GenerateLive(
        "stream " + scenario + " --lockstep --pacing burst --duration 20 " + stream +
        " >/dev/null & pid=$!; timeout 120 " + driver + " --front 0 --resolution 0.5; status=$?; " +
        "kill -INT $pid; wait $pid; exit $status");
    EXPECT_EQ(ended.status, 0) << ended.said;
    return ended.said;
  };
  const std::string by_node = report_of(
      "--protocol ros2 --domain " + domain + " --step-topic /step --commands-topic /brake",
      "env PYTHONPATH=" RAILCAST_SOURCE_DIR
      "/tests/generator/extras/dds/ros_stand_in ROS_DOMAIN_ID=" +
          domain +
          " RAILCAST_FAST_BRIDGE=" RAILCAST_FAST_BRIDGE " " RAILCAST_SOURCE_DIR
          "/examples/brake_node.py --points /coarse/points --step /step");
  EXPECT_THAT(by_node, testing::HasSubstr("with 10.00 m/s, braking distance 25.5 m, gap left "));
  EXPECT_EQ(by_node,
            report_of("--fields x,y,z --to :" + frames_port + " --commands-port " + commands_port,
                      RAILCAST_SOURCE_DIR "/examples/brake_client.py --lockstep "
                                          "--deceleration 2 --stream 127.0.0.1:" +
                          frames_port + " --commands 127.0.0.1:" + commands_port));
}

double SecondsOf(const ros::Time& time) {
  return time.sec + 1e-9 * time.nanosec;
}

TEST(Ros2Stream, StampsMessagesWithTheTimeOfDayIfAskedTo) {
  const TemporaryDirectory folder;
  const std::string scenario = CoarseScenario(folder.path());
  const std::uint32_t domain = FreeDomain();
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  const double begin_s = std::chrono::duration<double>(now).count();
  Stream stream(RosArguments(scenario, domain) +
                " --clock utc --lockstep --step-topic /step --pacing burst --duration 0.15");
  FastParticipant node(domain);
  FastReader& motion = node.Read("rt/odometry", kOdometryType);
  FastReader& clock = node.Read("rt/clock", ros::TypeOf<ros::Clock>().dds_name);
  FastReader& statics = node.Read("rt/tf_static", ros::TypeOf<ros::TfMessage>().dds_name, true);
  // The last: who knows of it knows of all, and no frame comes before.
  FastReader& clouds = node.Read(kPoints, kCloudType);
  auto& steps = node.Write("rt/step", ros::TypeOf<ros::Time>().dds_name);
  MessageBytes step = StepAt(0);
  ASSERT_TRUE(WaitUntilTrue([&] { return steps.write(&step) && !clouds.WaitFor(1, 100).empty(); }));
  for (std::size_t i = 0; i < 3; ++i) {
    ASSERT_GT(clouds.WaitFor(i + 1).size(), i);
    const auto cloud = ros::FromCdr<ros::PointCloud2>(clouds.WaitFor(i + 1)[i]);
    const double stamp_s = SecondsOf(cloud.header.stamp);
    EXPECT_NEAR(stamp_s, begin_s, 60.0);
    EXPECT_EQ(ros::FromCdr<ros::Odometry>(motion.WaitFor(i + 1).at(i)).header.stamp,
              cloud.header.stamp);
    EXPECT_EQ(ros::FromCdr<ros::Clock>(clock.WaitFor(i + 1).at(i)).clock, cloud.header.stamp);
    // Steps are by the same clock.
    step = ros::ToCdr(cloud.header.stamp);
    EXPECT_TRUE(steps.write(&step));
  }
  const auto transforms = ros::FromCdr<ros::TfMessage>(statics.WaitFor(1).at(0));
  EXPECT_NEAR(SecondsOf(transforms.transforms.at(0).header.stamp), begin_s, 60.0);
  EXPECT_THAT(stream.Wait(), ExitsWith(0));
}

TEST(Ros2Stream, TakesItsDomainFromTheEnvironmentUnlessToldOtherwise) {
  const TemporaryDirectory folder;
  const std::string scenario = CoarseScenario(folder.path());
  const std::string domain = std::to_string(FreeDomain());
  const auto begin_of = [&](const std::string& environment, const std::string& options) {
    const Ended ended = RunCommand(environment + " " RAILCAST_GENERATE " stream " + scenario +
                                   " --protocol ros2 --duration 0.05" + options);
    return ended.said.substr(0, ended.said.find('\n'));
  };
  EXPECT_EQ(begin_of("ROS_DOMAIN_ID=" + domain, ""),
            "coarse: ros2 in domain " + domain + ", on loopback");
  EXPECT_EQ(begin_of("ROS_DOMAIN_ID=233", " --interface lo --domain " + domain),
            "coarse: ros2 in domain " + domain + ", on lo");
  EXPECT_EQ(begin_of("ROS_DOMAIN_ID=233", ""),
            "ROS_DOMAIN_ID: must be a whole number from 0 to 232 (got \"233\")");
  EXPECT_EQ(begin_of("ROS_DOMAIN_ID=x", ""),
            "ROS_DOMAIN_ID: must be a whole number from 0 to 232 (got \"x\")");
}

TEST(Ros2Stream, RefusesOptionsThatDoNotGoTogether) {
  const TemporaryDirectory folder;
  const std::string scenario = CoarseScenario(folder.path());
  const auto fault_of = [&](const std::string& options) {
    const Ended ended = Generate("stream " + scenario + " --duration 0.05" + options);
    EXPECT_EQ(ended.status, 1) << options;
    return ended.said;
  };
  EXPECT_EQ(fault_of(" --domain 3"), "--domain: is for protocol ros2 (got railcast)\n");
  EXPECT_EQ(fault_of(" --commands-topic /brake"),
            "--commands-topic: is for protocol ros2 (got railcast)\n");
  EXPECT_EQ(fault_of(" --protocol ros2 --to :9"),
            "--to: must be left out with protocol ros2, which sends messages to whoever reads "
            "their topics\n");
  EXPECT_EQ(fault_of(" --protocol ros2 --lockstep --step-topic /2"),
            "--step-topic: must be a topic of ROS 2: / and letters, digits and _, such as /step "
            "(got \"/2\")\n");
  EXPECT_EQ(fault_of(" --protocol ros2 --clock tai"),
            "--clock: tai is for packets of sensors that PTP synchronises, Hesai's and Ouster's "
            "(got ros2)\n");
  EXPECT_EQ(fault_of(" --protocol ros2 --commands-topic brake"),
            "--commands-topic: must be a topic of ROS 2: / and letters, digits and _, such as "
            "/brake (got \"brake\")\n");
  EXPECT_THAT(fault_of(" --protocol ros2 --interface no_such_one"),
              testing::StartsWith("protocol ros2: interface: must be the name or an address "
                                  "of a network interface that is up, one of "));
}

}  // namespace
}  // namespace railcast
