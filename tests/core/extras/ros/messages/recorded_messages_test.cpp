// Messages that others encoded.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <string>

#include "core/extras/ros/bag/bag.h"
#include "core/extras/ros/messages/cdr.h"
#include "core/extras/ros/messages/sensor_messages.h"
#include "core/io/write_file.h"

namespace railcast::ros {
namespace {

const std::filesystem::path kMcapData = std::filesystem::path(RAILCAST_SHARED_DATA_DIR) / "mcap";

std::vector<std::byte> ReadMessage(const std::filesystem::path& file) {
  const std::string text = ReadFileWhole(file);
  std::vector<std::byte> bytes(text.size());
  std::memcpy(bytes.data(), text.data(), text.size());
  return bytes;
}

float FloatAt(const PointCloud2& cloud, std::size_t point, std::size_t offset) {
  float value = 0.0F;
  std::memcpy(&value, &cloud.data[point * cloud.point_step + offset], sizeof value);
  return value;
}

// Foxglove's library encoded it (make.mjs beside it says of what).
TEST(RecordedMessages, FoxglovesPointCloudIsReadAndWrittenAlike) {
  const std::filesystem::path file = kMcapData / "pointcloud2/first_message.cdr";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "there is no " << file;
  const std::vector<std::byte> bytes = ReadMessage(file);
  const auto cloud = FromCdr<PointCloud2>(bytes);
  EXPECT_EQ(cloud.header.frame_id, "velodyne");
  EXPECT_EQ(cloud.header.stamp, (Time{1'614'315'746, 471'294'674}));
  EXPECT_EQ(cloud.height, 1U);
  EXPECT_EQ(cloud.point_step, 22U);
  ASSERT_EQ(cloud.fields.size(), 6U);
  EXPECT_EQ(cloud.fields[4], (PointField{"ring", 16, PointField::kUint16, 1}));
  ASSERT_EQ(cloud.data.size(), std::size_t{cloud.width} * cloud.point_step);
  // Every fourth point, of which the intensity is 7 j modulo 256.
  EXPECT_EQ(FloatAt(cloud, 10, 12), static_cast<float>(7 * 40 % 256));
  EXPECT_EQ(ToCdr(cloud), bytes);
}

/// Messages in the bags of rosbag2's tests.
struct String {
  static constexpr std::string_view kName = "std_msgs/msg/String";
  static constexpr std::array kFields = {"data"};
  std::string data;
};

struct BasicTypes {
  static constexpr std::string_view kName = "test_msgs/msg/BasicTypes";
  static constexpr std::array kFields = {
      "bool_value",   "byte_value",  "char_value",  "float32_value", "float64_value",
      "int8_value",   "uint8_value", "int16_value", "uint16_value",  "int32_value",
      "uint32_value", "int64_value", "uint64_value"};
  bool bool_value{};
  std::uint8_t byte_value{}, char_value{};
  float float32_value{};
  double float64_value{};
  std::int8_t int8_value{};
  std::uint8_t uint8_value{};
  std::int16_t int16_value{};
  std::uint16_t uint16_value{};
  std::int32_t int32_value{};
  std::uint32_t uint32_value{};
  std::int64_t int64_value{};
  std::uint64_t uint64_value{};
};

// Reads and writes the messages of a type in a bag, and returns them.
template <typename Message>
std::vector<Message> ReadAndWrite(const std::filesystem::path& path) {
  std::vector<Message> messages;
  const auto bag = bag::OpenBag(path);
  while (const auto found = bag->Next()) {
    if (bag->topics()[found->topic].type != Message::kName) continue;
    messages.push_back(FromCdr<Message>(found->data));
    std::vector<std::byte> padded = ToCdr(messages.back());
    // ROS 2 fills up to whole words.
    EXPECT_LT(found->data.size() - padded.size(), 4U);
    padded.resize(found->data.size());
    EXPECT_TRUE(std::ranges::equal(padded, found->data)) << messages.size();
  }
  return messages;
}

const std::filesystem::path kBags = std::filesystem::path(RAILCAST_SHARED_DATA_DIR) / "rosbag2";

TEST(RecordedMessages, Ros2sNumbersAreReadAndWrittenAlike) {
  const auto bag = kBags / "rosbag2_tests/resources/sqlite3/cdr_test";
  if (!std::filesystem::exists(bag)) GTEST_SKIP() << "there is no " << bag;
  const std::vector<BasicTypes> messages = ReadAndWrite<BasicTypes>(bag);
  ASSERT_EQ(messages.size(), 3U);
  for (const BasicTypes& message : messages) EXPECT_EQ(message.int32_value, 123);
}

TEST(RecordedMessages, Ros2sStringsAreReadAndWrittenAlike) {
  const auto bag = kBags / "rosbag2_py/test/resources/sqlite3/talker/talker.db3";
  if (!std::filesystem::exists(bag)) GTEST_SKIP() << "there is no " << bag;
  const std::vector<String> messages = ReadAndWrite<String>(bag);
  ASSERT_EQ(messages.size(), 10U);
  for (const String& message : messages) EXPECT_TRUE(message.data.starts_with("Hello, world! "));
}

}  // namespace
}  // namespace railcast::ros
