// `--format mcap` and `--format rosbag2`: the frames of a run as messages of ROS 2.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "core/extras/ros/bag/bag.h"
#include "core/extras/ros/messages/cdr.h"
#include "core/extras/ros/messages/scene_messages.h"
#include "core/extras/ros/messages/sensor_messages.h"
#include "core/io/verify/verification.h"
#include "core/io/write_file.h"
#include "generator/run/all_sensors.h"
#include "tests/core/io/damage.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/recording/read_all.h"
#include "tests/generator/sequence/sequence_runs.h"

namespace railcast {
namespace {

namespace fs = std::filesystem;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

/// The messages of a bag, by topic.
struct ReadBag {
  std::map<std::string, std::vector<std::vector<std::byte>>> messages;
  std::map<std::string, std::vector<std::int64_t>> times_ns;
  std::vector<std::string> attachments;
};

ReadBag Read(const fs::path& path) {
  ReadBag read;
  const auto reader = bag::OpenBag(path);
  while (const auto message = reader->Next()) {
    const std::string& topic = reader->topics()[message->topic].name;
    read.messages[topic].emplace_back(message->data.begin(), message->data.end());
    read.times_ns[topic].push_back(message->time_ns);
  }
  for (const bag::BagAttachment& file : reader->ReadAttachments()) {
    read.attachments.push_back(file.name);
  }
  return read;
}

std::vector<std::string> TopicsOf(const ReadBag& bag) {
  std::vector<std::string> topics;
  for (const auto& [topic, messages] : bag.messages) topics.push_back(topic);
  return topics;
}

class Bags : public SequenceRuns {
 protected:
  Bags() : SequenceRuns(kNumFrames) {}

  void MakeFirst(const std::string& name, const std::string& format, std::uint32_t num_frames) {
    for (const SequenceResult& result : SequenceRuns::MakeFirst(name, format, num_frames)) {
      EXPECT_FALSE(result.is_complete);
    }
  }
  // Gives the scenario a second sensor that has another rate.
  void AddSensor() const {
    auto scenario = nlohmann::ordered_json::parse(ReadFileWhole(scenario_));
    auto rear = scenario["lidar"];
    scenario["lidar"]["name"] = "front";
    rear["name"] = "rear";
    rear["scan"]["rate_hz"] = 4;
    rear["mount"] = {{"position_m", {-2, 0, 3}}, {"yaw_deg", 180}};
    scenario["lidars"] = {scenario["lidar"], rear};
    scenario.erase("lidar");
    WriteFileWhole(scenario_, scenario.dump());
  }

  static constexpr std::uint32_t kNumFrames = 6;
};

TEST_F(Bags, HoldTheCloudsOfTheFilesBitByBit) {
  const fs::path files = Make("files", "--format pcd " + frames_);
  const ReadBag bag = Read(Make("bag", "--format mcap " + frames_) / "frames.mcap");
  const auto& clouds = bag.messages.at("/beams/points");
  ASSERT_EQ(clouds.size(), kNumFrames);
  for (std::size_t i = 0; i < clouds.size(); ++i) {
    const auto cloud = ros::FromCdr<ros::PointCloud2>(clouds[i]);
    const std::string pcd = ReadFileWhole(files / ("frames/00000" + std::to_string(i) + ".pcd"));
    ASSERT_GE(pcd.size(), cloud.data.size());
    EXPECT_EQ(std::string(cloud.data.begin(), cloud.data.end()),
              pcd.substr(pcd.size() - cloud.data.size()));
    EXPECT_EQ(cloud.data.size(), std::size_t{cloud.width} * cloud.height * 63);
    EXPECT_EQ(bag.times_ns.at("/beams/points")[i], 100'000'000LL * static_cast<int>(i));
  }
}

// With the poses and objects that stand beside the bag.
TEST_F(Bags, AreOpenedAsTheSequencesThatTheyBelongTo) {
  const std::vector<RecordedFrame> expected = ReadAll(Make("files", "--format pcd " + frames_));
  for (const std::string format : {"mcap", "rosbag2"}) {
    const std::vector<RecordedFrame> frames =
        ReadAll(Make(format, "--format " + format + " " + frames_));
    ASSERT_EQ(frames.size(), expected.size());
    for (std::size_t i = 0; i < frames.size(); ++i) {
      const Frame& frame = frames[i].frame;
      EXPECT_EQ(frames[i].fields, expected[i].fields);
      EXPECT_TRUE(frames[i].is_grid);
      EXPECT_TRUE(std::ranges::equal(std::as_bytes(std::span(frame.x)),
                                     std::as_bytes(std::span(expected[i].frame.x))));
      EXPECT_EQ(frame.label, expected[i].frame.label);
      EXPECT_EQ(frame.time_ns, expected[i].frame.time_ns);
      EXPECT_EQ(frame.stamp_ns, expected[i].frame.stamp_ns);
      EXPECT_TRUE(frame.world_from_sensor.isApprox(expected[i].frame.world_from_sensor, 0.0));
      EXPECT_EQ(frames[i].objects.size(), expected[i].objects.size());
    }
  }
  const fs::path vendor = Make("vendor", "--format mcap --fields velodyne " + frames_);
  EXPECT_EQ(MessageOf([&] { (void)OpenRecording(vendor); }),
            vendor.string() + ": must have railcast's fields (got velodyne); open " +
                (vendor / "frames.mcap").string() + " instead");
}

TEST_F(Bags, HaveTheTopicsOfTheRun) {
  const ReadBag bag = Read(Make("bag", "--format mcap " + frames_) / "frames.mcap");
  EXPECT_THAT(TopicsOf(bag), ElementsAre("/beams/points", "/clock", "/objects", "/odometry", "/tf",
                                         "/tf_static", "/track"));
  // One more at the end of the last frame.
  EXPECT_EQ(bag.messages.at("/tf").size(), kNumFrames + 1);
  EXPECT_EQ(bag.times_ns.at("/tf").back(), 500'030'000);
  EXPECT_EQ(bag.messages.at("/tf_static").size(), 1U);
  EXPECT_THAT(bag.attachments,
              ElementsAre("scenario.resolved.json", "labels.json", "manifest.json"));
  const auto scene = ros::FromCdr<ros::SceneUpdate>(bag.messages.at("/objects")[0]);
  ASSERT_EQ(scene.entities.size(), 1U);
  EXPECT_EQ(scene.entities[0].id, "rock");
  const auto track = ros::FromCdr<ros::SceneUpdate>(bag.messages.at("/track")[0]);
  // Two rails of 1 km, with a point every 5 m.
  ASSERT_EQ(track.entities.at(0).lines.size(), 2U);
  EXPECT_EQ(track.entities[0].lines[0].points.size(), 201U);
}

// Of two sensors, of which the second's last frame ends later; the poses are those of poses.csv.
TEST_F(Bags, HaveThePosesOfAllFrames) {
  AddSensor();
  auto scenario = nlohmann::ordered_json::parse(ReadFileWhole(scenario_));
  scenario["vehicle"]["motion"] = {{"profile", {{{"time_s", 0}, {"speed_mps", 30}}}}};
  WriteFileWhole(scenario_, scenario.dump());
  for (const std::string name : {"mcap", "rosbag2"}) {
    const fs::path run = Make(name, "--format " + name + " " + frames_);
    const fs::path bag = run / (name == "mcap" ? "frames.mcap" : "rosbag2");
    for (const std::string sensor : {"front", "rear"}) {
      const auto frames = ReadAll(bag.string() + ":/" + sensor + "/points");
      const auto expected = ReadAll(run / sensor);
      ASSERT_EQ(frames.size(), expected.size());
      for (std::size_t i = 0; i < frames.size(); ++i) {
        EXPECT_TRUE(frames[i].has_pose) << sensor << " " << i;
        const Frame& frame = frames[i].frame;
        const Frame& other = expected[i].frame;
        EXPECT_TRUE(frame.world_from_sensor.isApprox(other.world_from_sensor, 1e-11));
        EXPECT_TRUE(frame.world_from_sensor_end.isApprox(other.world_from_sensor_end, 1e-11));
      }
    }
  }
}

TEST_F(Bags, HoldTheSameMessagesInEitherFormat) {
  const ReadBag mcap = Read(Make("mcap", "--format mcap " + frames_) / "frames.mcap");
  const ReadBag rosbag2 = Read(Make("rosbag2", "--format rosbag2 " + frames_) / "rosbag2");
  EXPECT_EQ(mcap.messages, rosbag2.messages);
  EXPECT_EQ(mcap.times_ns, rosbag2.times_ns);
}

TEST_F(Bags, HoldAllSensorsInTheOrderOfTheirFrames) {
  AddSensor();
  const fs::path out = Make("bag", "--format mcap --frames 5");
  const ReadBag bag = Read(out / "frames.mcap");
  EXPECT_THAT(bag.times_ns.at("/front/points"),
              ElementsAre(0, 100'000'000, 200'000'000, 300'000'000, 400'000'000));
  EXPECT_THAT(bag.times_ns.at("/rear/points"), ElementsAre(0, 250'000'000));
  const auto tf = ros::FromCdr<ros::TfMessage>(bag.messages.at("/tf_static")[0]);
  ASSERT_EQ(tf.transforms.size(), 2U);
  EXPECT_EQ(tf.transforms[1].child_frame_id, "rear");
  EXPECT_EQ(tf.transforms[1].transform.translation, (ros::RosVector3{-2.0, 0.0, 3.0}));
  EXPECT_THAT(bag.attachments, ElementsAre("scenario.resolved.json", "labels.json",
                                           "front.manifest.json", "rear.manifest.json"));
  EXPECT_THAT(FaultsOf(out / "front"), ElementsAre());
  EXPECT_THAT(FaultsOf(out / "rear"), ElementsAre());
}

TEST_F(Bags, HaveTheSameBytesOnAnyNumberOfThreads) {
  AddSensor();
  const std::string one =
      ReadFileWhole(Make("one", "--format mcap --threads 1 " + frames_) / "frames.mcap");
  EXPECT_TRUE(one ==
              ReadFileWhole(Make("four", "--format mcap --threads 4 " + frames_) / "frames.mcap"));
}

TEST_F(Bags, AreReadableUpToTheFrameAtWhichTheyWereInterrupted) {
  MakeFirst("bag", "mcap", 3);
  const fs::path unfinished = Out("bag") / "frames.mcap.part";
  EXPECT_EQ(Read(unfinished).messages.at("/beams/points").size(), 3U);
  // Behind a frame's messages stand their indices: six of 31 bytes.
  const std::string bytes = ReadFileWhole(unfinished);
  WriteFileWhole(unfinished, bytes.substr(0, bytes.size() - 6 * 31 - 5));
  EXPECT_EQ(Read(unfinished).messages.at("/beams/points").size(), 2U);
}

TEST_F(Bags, HaveTheSameBytesHoweverOftenTheyWereInterrupted) {
  for (const bool has_two_sensors : {false, true}) {
    if (has_two_sensors) AddSensor();
    const std::string name = has_two_sensors ? "two" : "one";
    const std::string whole = ReadFileWhole(Make(name, "--format mcap " + frames_) / "frames.mcap");
    for (const std::uint32_t num_frames : {0U, 4U}) {
      const std::string part = name + std::to_string(num_frames);
      MakeFirst(part, "mcap", num_frames);
      MakeFirst(part, "mcap", 1);
      EXPECT_TRUE(whole == ReadFileWhole(Make(part, "--format mcap " + frames_) / "frames.mcap"))
          << part;
    }
  }
}

TEST_F(Bags, OfSeveralSensorsAreVerifiedWithTheFolderAroundThem) {
  AddSensor();
  for (const std::string format : {"mcap", "rosbag2"}) {
    const fs::path out = Make(format, "--format " + format + " " + frames_);
    const auto faults = [&] { return VerifyFolder(out, [](double) {}).faults; };
    EXPECT_THAT(faults(), ElementsAre()) << format;
    WriteFileWhole(out / "notes.txt", "mine");
    EXPECT_THAT(faults(), ElementsAre((out / "notes.txt").string() +
                                      ": belongs to none of the run's sensors"));
  }
}

TEST_F(Bags, GoOnAfterTheLastWholeFrame) {
  const std::string whole =
      ReadFileWhole(Make("whole", "--format mcap " + frames_) / "frames.mcap");
  for (const std::size_t num_lost : {5U, 3000U}) {
    const std::string name = "bag" + std::to_string(num_lost);
    MakeFirst(name, "mcap", 4);
    // The power failed: the bag lost its end, though its frames were noted.
    const fs::path unfinished = Out(name) / "frames.mcap.part";
    const std::string bytes = ReadFileWhole(unfinished);
    WriteFileWhole(unfinished, bytes.substr(0, bytes.size() - num_lost));
    EXPECT_TRUE(whole == ReadFileWhole(Make(name, "--format mcap " + frames_) / "frames.mcap"))
        << num_lost;
  }
}

TEST_F(Bags, OfRosbag2GoOnAfterTheLastWholeFrame) {
  const ReadBag whole = Read(Make("whole", "--format rosbag2 " + frames_) / "rosbag2");
  MakeFirst("bag", "rosbag2", 3);
  EXPECT_EQ(Read(Out("bag") / "rosbag2").messages.at("/beams/points").size(), 3U);
  EXPECT_EQ(Read(Make("bag", "--format rosbag2 " + frames_) / "rosbag2").messages, whole.messages);
}

TEST_F(Bags, AreVerified) {
  for (const char* format : {"mcap", "rosbag2"}) {
    const fs::path out = Make(format, std::string("--format ") + format + " " + frames_);
    EXPECT_THAT(FaultsOf(out), ElementsAre());
    EXPECT_THAT(Run(std::string("--format ") + format + " " + frames_ + " --out " + out.string()),
                HasSubstr("already complete"));
  }
}

TEST_F(Bags, OfOtherFramesAreFaults) {
  const fs::path out = Make("bag", "--format mcap " + frames_);
  const fs::path other = Make("other", "--format mcap --seed 7 --start-frame 1 " + frames_);
  fs::copy_file(other / "frames.mcap", out / "frames.mcap", fs::copy_options::overwrite_existing);
  const std::vector<std::string> faults = FaultsOf(out);
  ASSERT_FALSE(faults.empty());
  EXPECT_THAT(faults.front(), HasSubstr("/frames.mcap: must have the hash "));
  EXPECT_THAT(faults, Contains(out.string() + "/frames.jsonl:1: must have its clouds in " +
                               out.string() + "/frames.mcap (got none)"));
}

TEST_F(Bags, HaveTheFieldsOfAVendorsDriver) {
  const fs::path out = Make("bag", "--format mcap --fields velodyne " + frames_);
  const auto cloud =
      ros::FromCdr<ros::PointCloud2>(Read(out / "frames.mcap").messages.at("/beams/points").at(0));
  EXPECT_EQ(cloud.point_step, 22U);
  EXPECT_EQ(nlohmann::json::parse(ReadFileWhole(out / "run.json"))["fields"], "velodyne");
}

TEST_F(Bags, RefuseWhatTheyCannotHold) {
  const std::string out = " --out " + Out("bag").string();
  EXPECT_THAT(Run("--format pcd --fields hesai" + out, 1),
              HasSubstr("--fields hesai: must be with --format mcap or rosbag2 (got pcd)"));
  EXPECT_THAT(Run("--format mcap --fields label" + out, 1),
              HasSubstr("--fields: must contain x, y and z for messages of ROS 2 (got label)"));
  EXPECT_FALSE(fs::exists(Out("bag")));
}

// What Foxglove's libraries for Node.js read in a bag; null without them. They are looked for where
// NODE_PATH says.
nlohmann::json ReadByFoxglove(const fs::path& bag) {
  const std::string script = RAILCAST_SOURCE_DIR "/tests/generator/extras/ros/read_bag.cjs";
  const Ended has_all = RunCommand(
      "node -e 'for (const name of [\"@mcap/core\", \"@mcap/nodejs\", \"@foxglove/rosmsg\", "
      "\"@foxglove/rosmsg2-serialization\", \"@foxglove/rosbag2\", \"@foxglove/wasm-zstd\", "
      "\"sql.js\"]) require.resolve(name)'");
  if (has_all.status != 0) return nullptr;
  const Ended run = RunCommand("node " + script + " " + bag.string());
  EXPECT_EQ(run.status, 0) << run.said;
  return nlohmann::json::parse(run.said, nullptr, false);
}

void ExpectTheRun(const nlohmann::json& found, const fs::path& manifest_file) {
  const auto manifest = nlohmann::json::parse(ReadFileWhole(manifest_file));
  const nlohmann::json& topics = found["topics"];
  EXPECT_EQ(topics["/beams/points"]["type"], "sensor_msgs/msg/PointCloud2");
  EXPECT_EQ(topics["/beams/points"]["times"].size(), 6U);
  EXPECT_EQ(topics["/beams/points"]["first"]["frame"], "beams");
  EXPECT_EQ(topics["/tf_static"]["first"], nlohmann::json({"base_link>beams"}));
  EXPECT_EQ(topics["/tf"]["first"], nlohmann::json({"map>base_link"}));
  EXPECT_NEAR(topics["/odometry"]["first"]["x"].get<double>(), 400.0, 1e-9);
  EXPECT_EQ(topics["/objects"]["first"][0]["id"], "rock");
  EXPECT_EQ(topics["/objects"]["first"][0]["cubes"], 1);
  EXPECT_EQ(topics["/track"]["first"][0]["lines"], 2);
  EXPECT_EQ(topics["/clock"]["times"].size(), 6U);
  EXPECT_GT(manifest["points"], 0);
}

TEST_F(Bags, AreReadByFoxglovesMcapLibrary) {
  const fs::path out = Make("bag", "--format mcap " + frames_);
  const nlohmann::json found = ReadByFoxglove(out / "frames.mcap");
  if (found.is_null()) GTEST_SKIP() << "node or npm's @mcap/core and others are missing";
  ExpectTheRun(found, out / "manifest.json");
  EXPECT_EQ(found["profile"], "ros2");
  // One for what is said once, one for each frame, and one for the pose at the end.
  EXPECT_EQ(found["chunks"], 8);
  EXPECT_EQ(found["attachments"],
            nlohmann::json({"scenario.resolved.json", "labels.json", "manifest.json"}));
}

TEST_F(Bags, AreReadByFoxglovesRosbag2LibraryWithItsOwnDefinitions) {
  const fs::path out = Make("bag", "--format rosbag2 " + frames_);
  const nlohmann::json found = ReadByFoxglove(out / "rosbag2/rosbag2_0.db3");
  if (found.is_null()) GTEST_SKIP() << "node or npm's @foxglove/rosbag2 and others are missing";
  ExpectTheRun(found, out / "manifest.json");
}

}  // namespace
}  // namespace railcast
