// Messages that others encoded.
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <string>

#include "core/io/ros/cdr.h"
#include "core/io/ros/sensor_messages.h"
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

}  // namespace
}  // namespace railcast::ros
