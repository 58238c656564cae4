// Bags that ROS 2 itself wrote, in all versions of its formats.
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "core/base/input_file.h"
#include "core/extras/ros/bag/bag.h"
#include "core/extras/ros/bag/bag_metadata.h"
#include "core/extras/ros/bag/sqlite_database.h"
#include "core/extras/ros/mcap/compression.h"
#include "tests/core/extras/ros/bag/read_bag.h"
#include "tests/core/io/message_of.h"
#include "tests/core/io/temporary_directory.h"

namespace railcast::bag {
namespace {

class RealBags : public testing::Test {
 protected:
  void SetUp() override {
    if (!exists(root_)) GTEST_SKIP() << root_ << " is not there";
  }
  [[nodiscard]] std::filesystem::path In(const std::string& name) const { return root_ / name; }

  const std::filesystem::path root_ = RAILCAST_SHARED_DATA_DIR "/rosbag2";
  TemporaryDirectory folder_;
};

std::map<std::filesystem::path, std::uintmax_t> FilesBelow(const std::filesystem::path& root) {
  std::map<std::filesystem::path, std::uintmax_t> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root)) {
    if (entry.is_regular_file()) files.emplace(entry.path(), entry.file_size());
  }
  return files;
}

TEST_F(RealBags, HoldAsManyMessagesAsTheirMetadataSay) {
  std::size_t num_bags = 0;
  const auto before = FilesBelow(root_);
  for (const auto& [file, size] : before) {
    if (file.filename() != "metadata.yaml") continue;
    SCOPED_TRACE(file);
    const YAML::Node stated = YAML::LoadFile(file)["rosbag2_bagfile_information"];
    const auto messages = MessagesIn(file.parent_path());
    EXPECT_EQ(messages.size(), stated["message_count"].as<std::size_t>());
    EXPECT_TRUE(std::ranges::is_sorted(messages, {}, &HeldMessage::time_ns));
    ++num_bags;
  }
  EXPECT_EQ(num_bags, 21U);
  EXPECT_EQ(FilesBelow(root_), before);
}

// The same messages were written to both formats.
TEST_F(RealBags, HoldTheSameInBothFormats) {
  for (const auto& [mcap, db3] : std::vector<std::pair<std::string, std::string>>{
           {"rosbag2_tests/resources/mcap/cdr_test", "rosbag2_tests/resources/sqlite3/cdr_test"},
           {"rosbag2_py/test/resources/mcap/wbag", "rosbag2_py/test/resources/sqlite3/wbag"},
           {"rosbag2_py/test/resources/mcap/convert_a",
            "rosbag2_py/test/resources/sqlite3/convert_a"}}) {
    auto a = MessagesIn(In(mcap));
    auto b = MessagesIn(In(db3));
    ASSERT_EQ(a.size(), b.size()) << mcap;
    // Those of one time are in the order of their files.
    for (auto* messages : {&a, &b}) {
      std::ranges::sort(*messages, {}, [](const HeldMessage& message) {
        return std::tuple(message.time_ns, message.topic, message.data);
      });
    }
    EXPECT_TRUE(a == b) << mcap;
  }
}

TEST_F(RealBags, AreReadWithoutTheirMetadata) {
  for (const char* format : {"mcap", "sqlite3"}) {
    const auto folder = In(std::string("rosbag2_py/test/resources/") + format +
                           "/reindex_test_bags/multiple_files");
    const auto messages = MessagesIn(folder);
    std::size_t num_alone = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      num_alone += MessagesIn(entry.path()).size();
    }
    EXPECT_EQ(messages.size(), num_alone);
    EXPECT_EQ(messages.size(), 3177U);
    EXPECT_TRUE(std::ranges::is_sorted(messages, {}, &HeldMessage::time_ns));
  }
}

TEST_F(RealBags, SayWhatTheirTopicsAre) {
  const auto bag = OpenBag(In("rosbag2_cpp/test/rosbag2_cpp/bags/topics_and_services.db3"));
  const auto topic = std::ranges::find(bag->topics(), "/rosout", &BagTopic::name);
  ASSERT_NE(topic, bag->topics().end());
  EXPECT_EQ(topic->type, "rcl_interfaces/msg/Log");
  EXPECT_EQ(topic->hash, "RIHS01_e28ce254ca8abc06abf92773b74602cdbf116ed34fbaf294fb9f81da9f318eac");
  EXPECT_TRUE(topic->is_latched);
  EXPECT_NE(topic->definition.find("builtin_interfaces/Time stamp"), std::string::npos);
}

// The directory exists and holds nothing.
TEST_F(RealBags, AreRefusedWhereThereIsNone) {
  EXPECT_EQ(MessageOf([&] { (void)OpenBag(In("rosbag2_tests/resources/empty_dir")); }),
            In("rosbag2_tests/resources/empty_dir").string() +
                ": must hold .mcap or .db3 files (got none)");
  EXPECT_FALSE(IsBag(In("rosbag2_tests/resources/empty_dir")));
  EXPECT_TRUE(IsBag(In("rosbag2_py/test/resources/mcap/wbag")));
  EXPECT_EQ(MessagesIn(In("ros2bag/test/resources/empty_bag")).size(), 0U);
}

// By file and by message, as `ros2 bag record --compression-mode` does.
TEST_F(RealBags, AreReadCompressed) {
  const auto source = In("rosbag2_tests/resources/sqlite3/cdr_test");
  const auto plain = MessagesIn(source);
  const std::string bytes = ReadFileWhole(source / "cdr_test_0.db3");
  const auto zipped = mcap::Compressed(std::as_bytes(std::span(bytes)), McapCompression::kZstd);
  std::ofstream(folder_.path() / "cdr_test_0.db3.zstd", std::ios::binary)
      .write(reinterpret_cast<const char*>(zipped.data()),
             static_cast<std::streamsize>(zipped.size()));
  EXPECT_TRUE(MessagesIn(folder_.path()) == plain);
  std::ofstream(folder_.path() / "metadata.yaml")
      << "rosbag2_bagfile_information:\n  version: 9\n  compression_format: zstd\n"
         "  compression_mode: FILE\n  relative_file_paths:\n    - cdr_test_0.db3.zstd\n";
  EXPECT_TRUE(MessagesIn(folder_.path()) == plain);
}

TEST_F(RealBags, AreReadWithEachMessageCompressed) {
  const auto plain = OpenBag(In("rosbag2_tests/resources/mcap/cdr_test"));
  const auto writer = CreateMcap(folder_.path() / "bag_0.mcap", McapCompression::kNone);
  for (const BagTopic& topic : plain->topics()) (void)writer->Add(topic);
  while (const auto message = plain->Next()) {
    writer->Write({message->topic, message->time_ns,
                   mcap::Compressed(message->data, McapCompression::kZstd)});
  }
  writer->Close();
  std::ofstream(folder_.path() / "metadata.yaml")
      << "rosbag2_bagfile_information:\n  version: 5\n  compression_format: zstd\n"
         "  compression_mode: MESSAGE\n  relative_file_paths:\n    - bag_0.mcap\n";
  EXPECT_TRUE(MessagesIn(folder_.path()) ==
              MessagesIn(In("rosbag2_tests/resources/mcap/cdr_test")));
}

TEST_F(RealBags, HaveTheTablesThatOursHave) {
  const auto tables_of = [](const std::filesystem::path& file) {
    SqliteDatabase database(file, SqliteAccess::kRead, "database");
    SqliteStatement list(database, "SELECT sql FROM sqlite_master ORDER BY rowid");
    std::vector<std::string> tables;
    while (list.Step()) tables.push_back(list.Text(0));
    return tables;
  };
  const auto ours = CreateRosbag2(folder_.path() / "bag");
  EXPECT_EQ(tables_of(folder_.path() / "bag/bag_0.db3"),
            tables_of(In("rosbag2_cpp/test/rosbag2_cpp/bags/topics_and_services.db3")));
}

/// Returns what a metadata.yaml of version 8 says.
BagMetadata MetadataIn(const YAML::Node& stated) {
  BagMetadata metadata{.storage = stated["storage_identifier"].as<std::string>(),
                       .file = stated["relative_file_paths"][0].as<std::string>(),
                       .topics = {}};
  metadata.start_ns = stated["starting_time"]["nanoseconds_since_epoch"].as<std::int64_t>();
  metadata.duration_ns = stated["duration"]["nanoseconds"].as<std::int64_t>();
  for (const YAML::Node& counted : stated["topics_with_message_count"]) {
    const YAML::Node topic = counted["topic_metadata"];
    metadata.topics.push_back(
        {{.name = topic["name"].as<std::string>(),
          .type = topic["type"].as<std::string>(),
          .definition = {},
          .hash = topic["type_description_hash"].as<std::string>(),
          .is_latched = IsLatchedQos(topic["offered_qos_profiles"].as<std::string>())},
         counted["message_count"].as<std::uint64_t>()});
  }
  return metadata;
}

TEST_F(RealBags, HaveTheMetadataThatOursHave) {
  for (const char* format : {"mcap", "sqlite3"}) {
    const std::string text = ReadFileWhole(In(std::string("rosbag2_tests/resources/") + format +
                                              "/bag_with_topics_and_service_events/metadata.yaml"));
    const YAML::Node stated = YAML::Load(text)["rosbag2_bagfile_information"];
    const std::string ours = MetadataFileText(MetadataIn(stated), MetadataVersion::kIron);
    EXPECT_EQ(ours.substr(0, text.size()), text);
    EXPECT_LE(ours.size(), text.size() + 1);  // A line's end.
  }
}

TEST(BagMetadataText, NamesPoliciesAsJazzyDoes) {
  BagMetadata metadata{.storage = "sqlite3", .file = "bag_0.db3", .topics = {}};
  metadata.start_ns = 5;
  metadata.duration_ns = 10;
  metadata.topics.push_back({TopicNamed("/tf_static", true), 3});
  EXPECT_EQ(MetadataFileText(metadata, MetadataVersion::kJazzy), R"(rosbag2_bagfile_information:
  version: 9
  storage_identifier: sqlite3
  duration:
    nanoseconds: 10
  starting_time:
    nanoseconds_since_epoch: 5
  message_count: 3
  topics_with_message_count:
    - topic_metadata:
        name: /tf_static
        type: std_msgs/msg/String
        serialization_format: cdr
        offered_qos_profiles:
          - history: unknown
            depth: 0
            reliability: reliable
            durability: transient_local
            deadline:
              sec: 9223372036
              nsec: 854775807
            lifespan:
              sec: 9223372036
              nsec: 854775807
            liveliness: automatic
            liveliness_lease_duration:
              sec: 9223372036
              nsec: 854775807
            avoid_ros_namespace_conventions: false
        type_description_hash: RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18
      message_count: 3
  compression_format: ""
  compression_mode: ""
  relative_file_paths:
    - bag_0.db3
  files:
    - path: bag_0.db3
      starting_time:
        nanoseconds_since_epoch: 5
      duration:
        nanoseconds: 10
      message_count: 3
  custom_data: ~
  ros_distro: jazzy
)");
}

}  // namespace
}  // namespace railcast::bag
