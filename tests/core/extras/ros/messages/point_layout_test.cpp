#include "core/extras/ros/messages/point_layout.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "core/extras/packets/velodyne/velodyne_packet.h"
#include "tests/core/io/example_frame.h"
#include "tests/core/io/message_of.h"

namespace railcast::ros {
namespace {

template <typename Number>
Number ValueAt(const PointCloud2& cloud, std::size_t point, std::uint32_t offset) {
  Number value{};
  std::memcpy(&value, &cloud.data.at(point * cloud.point_step + offset), sizeof value);
  return value;
}

/// "x 0 7": name, offset and type of each field.
std::vector<std::string> FieldsOf(const PointCloud2& cloud) {
  std::vector<std::string> fields;
  for (const PointField& field : cloud.fields) {
    fields.push_back(field.name + " " + std::to_string(field.offset) + " " +
                     std::to_string(field.datatype));
    EXPECT_EQ(field.count, 1U);
  }
  return fields;
}

/// The frame's slots that have a point, in the order of the columns.
std::vector<std::size_t> PointSlots(const Frame& frame) {
  std::vector<std::size_t> slots;
  for (std::size_t i = 0; i < frame.width(); ++i) {
    for (std::size_t row = 0; row < frame.rows; ++row) {
      const std::size_t slot = row * frame.width() + i;
      if (HasPoint(frame.outcome[slot])) slots.push_back(slot);
    }
  }
  return slots;
}

PointCloud2 CloudIn(PointLayout layout, const Frame& frame) {
  return MakeCloud(frame, {layout, {}}, "lidar");
}

TEST(PointLayout, RailcastHoldsEveryFieldOfEverySlot) {
  const Frame frame = ExampleFrame(3);
  const PointCloud2 cloud = CloudIn(PointLayout::kRailcast, frame);
  EXPECT_EQ(cloud.height, frame.rows);
  EXPECT_EQ(cloud.width, frame.width());
  EXPECT_EQ(cloud.row_step, cloud.width * cloud.point_step);
  EXPECT_FALSE(cloud.is_dense);
  EXPECT_FALSE(cloud.is_bigendian);
  EXPECT_EQ(cloud.header.frame_id, "lidar");
  EXPECT_EQ(cloud.header.stamp, (Time{0, 300'000'000}));
  std::size_t field = 0;
  ForEachField(frame, [&](std::string_view name, std::string_view, const auto& values) {
    const PointField& stored = cloud.fields.at(field++);
    EXPECT_EQ(stored.name, name);
    for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
      EXPECT_EQ(std::memcmp(&cloud.data[slot * cloud.point_step + stored.offset], &values[slot],
                            sizeof values[slot]),
                0);
    }
  });
  EXPECT_EQ(field, cloud.fields.size());
}

TEST(PointLayout, RailcastHoldsTheChosenFieldsOnly) {
  const CloudSpec spec = ParseCloudSpec("label,z,y,x");
  EXPECT_EQ(FieldsOf(MakeCloud(ExampleFrame(0), spec, "lidar")),
            (std::vector<std::string>{"x 0 7", "y 4 7", "z 8 7", "label 12 6"}));
}

TEST(PointLayout, VelodyneIsThatOfTheOrganisedCloudsOfItsDriver) {
  const Frame frame = ExampleFrame(0);
  const PointCloud2 cloud = CloudIn(PointLayout::kVelodyne, frame);
  EXPECT_EQ(FieldsOf(cloud), (std::vector<std::string>{"x 0 7", "y 4 7", "z 8 7", "intensity 12 7",
                                                       "ring 16 4", "time 18 7"}));
  EXPECT_EQ(cloud.point_step, 22U);
  // A row for each firing of all lasers.
  EXPECT_EQ(cloud.height, frame.columns);
  EXPECT_EQ(cloud.width, frame.rows);
  EXPECT_FALSE(cloud.is_dense);
  for (std::size_t point = 0; point < frame.num_slots(); ++point) {
    const std::size_t slot = point % frame.rows * frame.columns + point / frame.rows;
    EXPECT_EQ(ValueAt<std::uint16_t>(cloud, point, 16), frame.ring[slot]);
    EXPECT_FLOAT_EQ(ValueAt<float>(cloud, point, 18),
                    1e-9F * static_cast<float>(frame.time_ns[slot]));
    const float intensity = ValueAt<float>(cloud, point, 12);
    if (!HasPoint(frame.outcome[slot])) {
      EXPECT_TRUE(std::isnan(ValueAt<float>(cloud, point, 0)));
      EXPECT_TRUE(std::isnan(intensity));
      continue;
    }
    EXPECT_EQ(ValueAt<float>(cloud, point, 0), frame.x[slot]);
    EXPECT_EQ(intensity, ReflectivityByte(frame.intensity[slot]));
  }
}

TEST(PointLayout, OusterIsThatOfItsDriversOriginalPointType) {
  const Frame frame = ExampleFrame(0);
  const PointCloud2 cloud = CloudIn(PointLayout::kOuster, frame);
  EXPECT_EQ(FieldsOf(cloud), (std::vector<std::string>{"x 0 7", "y 4 7", "z 8 7", "intensity 16 7",
                                                       "t 20 6", "reflectivity 24 4", "ring 26 4",
                                                       "ambient 28 4", "range 32 6"}));
  EXPECT_EQ(cloud.point_step, 48U);
  EXPECT_EQ(cloud.height, frame.rows);
  EXPECT_EQ(cloud.width, frame.columns);
  EXPECT_FALSE(cloud.is_dense);
  // The first row is the highest channel.
  for (std::size_t column = 0; column < frame.columns; ++column) {
    const std::size_t slot = (frame.rows - 1) * std::size_t{frame.columns} + column;
    EXPECT_EQ(ValueAt<std::uint16_t>(cloud, column, 26), 0);
    EXPECT_EQ(ValueAt<std::uint32_t>(cloud, column, 20), frame.time_ns[slot]);
    const auto range_mm = HasPoint(frame.outcome[slot])
                              ? static_cast<std::uint32_t>(std::lround(1e3F * frame.range_m[slot]))
                              : 0U;
    EXPECT_EQ(ValueAt<std::uint32_t>(cloud, column, 32), range_mm);
    EXPECT_EQ(std::isnan(ValueAt<float>(cloud, column, 0)), range_mm == 0);
  }
}

TEST(PointLayout, AutowareIsItsXyzircaedt) {
  Frame frame = ExampleFrame(0, 2, 4);
  const PointCloud2 cloud = CloudIn(PointLayout::kAutoware, frame);
  EXPECT_EQ(FieldsOf(cloud),
            (std::vector<std::string>{"x 0 7", "y 4 7", "z 8 7", "intensity 12 2",
                                      "return_type 13 2", "channel 14 4", "azimuth 16 7",
                                      "elevation 20 7", "distance 24 7", "time_stamp 28 6"}));
  EXPECT_EQ(cloud.point_step, 32U);
  const auto slots = PointSlots(frame);
  ASSERT_EQ(cloud.width, slots.size());
  for (std::size_t point = 0; point < slots.size(); ++point) {
    const std::size_t slot = slots[point];
    EXPECT_EQ(ValueAt<std::uint8_t>(cloud, point, 12), ReflectivityByte(frame.intensity[slot]));
    EXPECT_EQ(ValueAt<std::uint8_t>(cloud, point, 13), 0);
    EXPECT_EQ(ValueAt<std::uint16_t>(cloud, point, 14), frame.ring[slot]);
    const float azimuth_rad = ValueAt<float>(cloud, point, 16);
    const float elevation_rad = ValueAt<float>(cloud, point, 20);
    const float plan_m = std::hypot(frame.x[slot], frame.y[slot]);
    EXPECT_NEAR(plan_m * std::cos(azimuth_rad), frame.x[slot], 1e-5F * plan_m);
    EXPECT_NEAR(plan_m * std::sin(azimuth_rad), frame.y[slot], 1e-5F * plan_m);
    EXPECT_NEAR(plan_m * std::tan(elevation_rad), frame.z[slot], 1e-4F * plan_m);
    EXPECT_EQ(ValueAt<float>(cloud, point, 24), frame.range_m[slot]);
    EXPECT_EQ(ValueAt<std::uint32_t>(cloud, point, 28), frame.time_ns[slot]);
  }
  frame.returns = 2;
  frame.columns = 2;
  const PointCloud2 dual = CloudIn(PointLayout::kAutoware, frame);
  const auto dual_slots = PointSlots(frame);
  for (std::size_t point = 0; point < dual_slots.size(); ++point) {
    EXPECT_EQ(ValueAt<std::uint8_t>(dual, point, 13), dual_slots[point] % 2 == 0 ? 3 : 1);
  }
}

TEST(PointLayout, OusterHasACloudForEachReturn) {
  Frame frame = ExampleFrame(0, 2, 4);
  frame.returns = 2;
  frame.columns = 2;
  EXPECT_EQ(NumClouds(PointLayout::kOuster, 2), 2U);
  EXPECT_EQ(NumClouds(PointLayout::kVelodyne, 2), 1U);
  for (std::uint32_t i = 0; i < 2; ++i) {
    const PointCloud2 cloud = MakeCloud(frame, {PointLayout::kOuster, {}}, "lidar", {}, i);
    EXPECT_EQ(cloud.width, 2U);
    // Row 1 of the frame comes first; its slots are 4, 5 of column 0 and 6, 7 of column 1.
    EXPECT_EQ(ValueAt<std::uint32_t>(cloud, 0, 20), frame.time_ns[4 + i]);
    EXPECT_EQ(ValueAt<std::uint32_t>(cloud, 1, 20), frame.time_ns[6 + i]);
  }
}

TEST(PointLayout, HesaiHoldsPointsWithTheirTimesInSeconds) {
  const Frame frame = ExampleFrame(5);
  const PointCloud2 cloud = CloudIn(PointLayout::kHesai, frame);
  EXPECT_EQ(FieldsOf(cloud), (std::vector<std::string>{"x 0 7", "y 4 7", "z 8 7", "intensity 12 7",
                                                       "ring 16 4", "timestamp 18 8"}));
  EXPECT_EQ(cloud.point_step, 26U);
  const std::vector<std::size_t> slots = PointSlots(frame);
  EXPECT_EQ(cloud.height, 1U);
  ASSERT_EQ(cloud.width, slots.size());
  for (std::size_t point = 0; point < slots.size(); ++point) {
    const std::size_t slot = slots[point];
    EXPECT_EQ(ValueAt<float>(cloud, point, 4), frame.y[slot]);
    EXPECT_EQ(ValueAt<std::uint16_t>(cloud, point, 16), frame.rows - 1 - frame.ring[slot]);
    EXPECT_DOUBLE_EQ(ValueAt<double>(cloud, point, 18), 0.5 + 1e-9 * frame.time_ns[slot]);
  }
}

TEST(PointLayout, HesaiNumbersChannelsAsTheSensorDoes) {
  const Frame frame = ExampleFrame(5, 2, 9);
  const PointCloud2 cloud = MakeCloud(frame, {PointLayout::kHesai, {}}, "lidar", {5, 3});
  for (std::size_t point = 0; point < cloud.width; ++point) {
    const std::uint16_t row = frame.ring[PointSlots(frame)[point]];
    EXPECT_EQ(ValueAt<std::uint16_t>(cloud, point, 16), row == 0 ? 5 : 3);
  }
}

TEST(PointLayout, LivoxHoldsPointsWithTheirTimesInNanoseconds) {
  const Frame frame = ExampleFrame(5);
  const PointCloud2 cloud = CloudIn(PointLayout::kLivox, frame);
  EXPECT_EQ(FieldsOf(cloud), (std::vector<std::string>{"x 0 7", "y 4 7", "z 8 7", "intensity 12 7",
                                                       "tag 16 2", "line 17 2", "timestamp 18 8"}));
  EXPECT_EQ(cloud.point_step, 26U);
  EXPECT_TRUE(cloud.is_dense);
  const std::vector<std::size_t> slots = PointSlots(frame);
  ASSERT_EQ(cloud.width, slots.size());
  EXPECT_EQ(ValueAt<std::uint8_t>(cloud, 1, 17), frame.ring[slots[1]]);
  EXPECT_EQ(ValueAt<double>(cloud, 1, 18), 5e8 + frame.time_ns[slots[1]]);
}

TEST(PointLayout, LivoxHasNoMoreThan256Lines) {
  EXPECT_EQ(MessageOf([] { (void)CloudIn(PointLayout::kLivox, ExampleFrame(0, 257, 1)); }),
            "--fields livox: needs at most 256 channels (got 257)");
}

TEST(PointLayout, AevaHoldsPointsWithTheirVelocities) {
  const Frame frame = WithVelocities(ExampleFrame(5));
  const PointCloud2 cloud = CloudIn(PointLayout::kAeva, frame);
  EXPECT_EQ(FieldsOf(cloud),
            (std::vector<std::string>{"x 0 7", "y 4 7", "z 8 7", "reflectivity 12 7",
                                      "velocity 16 7", "time_offset_ns 20 6", "line_index 24 2"}));
  EXPECT_EQ(cloud.point_step, 25U);
  EXPECT_TRUE(cloud.is_dense);
  const std::vector<std::size_t> slots = PointSlots(frame);
  ASSERT_EQ(cloud.width, slots.size());
  for (std::size_t point = 0; point < slots.size(); ++point) {
    const std::size_t slot = slots[point];
    EXPECT_EQ(ValueAt<float>(cloud, point, 12), ReflectivityByte(frame.intensity[slot]));
    EXPECT_EQ(ValueAt<float>(cloud, point, 16), frame.radial_velocity_mps[slot]);
    EXPECT_EQ(ValueAt<std::uint32_t>(cloud, point, 20), frame.time_ns[slot]);
    EXPECT_EQ(ValueAt<std::uint8_t>(cloud, point, 24), frame.rows - 1 - frame.ring[slot]);
  }
}

TEST(PointLayout, AevaNeedsVelocitiesAndNoMoreThan256Lines) {
  EXPECT_EQ(MessageOf([] { (void)CloudIn(PointLayout::kAeva, ExampleFrame(0)); }),
            "--fields aeva: needs a sensor with lidar.velocity");
  EXPECT_EQ(MessageOf([] { (void)CloudIn(PointLayout::kAeva, ExampleFrame(0, 257, 1)); }),
            "--fields aeva: needs at most 256 channels (got 257)");
}

TEST(PointLayout, RailcastLeavesVelocitiesOutWhereTheFrameHasNone) {
  const CloudSpec spec = ParseCloudSpec("x,y,z,radial_velocity_mps", true);
  EXPECT_EQ(FieldsOf(MakeCloud(WithVelocities(ExampleFrame(0)), spec, "lidar")),
            (std::vector<std::string>{"x 0 7", "y 4 7", "z 8 7", "radial_velocity_mps 12 7"}));
  EXPECT_EQ(FieldsOf(MakeCloud(ExampleFrame(0), spec, "lidar")),
            (std::vector<std::string>{"x 0 7", "y 4 7", "z 8 7"}));
}

TEST(PointLayout, IsReadFromItsNameOrFromAListOfFields) {
  EXPECT_EQ(ParseCloudSpec("ouster").layout, PointLayout::kOuster);
  EXPECT_EQ(ParseCloudSpec("railcast"), ParseCloudSpec("all"));
  EXPECT_EQ(TextOf(ParseCloudSpec("hesai")), "hesai");
  EXPECT_EQ(TextOf(ParseCloudSpec("z,label,x,y")), "x,y,z,label");
  EXPECT_EQ(ParseCloudSpec("aeva", true).layout, PointLayout::kAeva);
  EXPECT_EQ(MessageOf([] { (void)ParseCloudSpec("aeva"); }),
            "--fields aeva: needs a sensor with lidar.velocity");
  EXPECT_EQ(MessageOf([] { (void)ParseCloudSpec("x,y,label"); }),
            "--fields: must contain x, y and z for messages of ROS 2 (got x,y,label)");
}

TEST(TimeOf, CountsWholeSecondsDownwardsBeforeZero) {
  EXPECT_EQ(TimeOf(1'500'000'000), (Time{1, 500'000'000}));
  EXPECT_EQ(TimeOf(-1), (Time{-1, 999'999'999}));
}

TEST(TimeOf, RefusesTimesThatTheMessagesCannotState) {
  constexpr std::int64_t kFirst_s = 0x8000'0000;
  EXPECT_EQ(TimeOf((kFirst_s - 1) * 1'000'000'000).sec, kFirst_s - 1);
  EXPECT_EQ(
      MessageOf([&] { static_cast<void>(TimeOf(kFirst_s * 1'000'000'000)); }),
      "stamps in messages of ROS 2 must be before 2038-01-19 03:14:08 (got 2147483648 s since "
      "1970)");
}

}  // namespace
}  // namespace railcast::ros
