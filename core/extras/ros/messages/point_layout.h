#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/extras/ros/messages/sensor_messages.h"
#include "railcast/enum_names.h"
#include "railcast/frame.h"
#include "railcast/io/cloud_files.h"

namespace railcast::ros {

/// The fields that the points of a PointCloud2 have: railcast's own, or those of a vendor's ROS 2
/// driver, with its names, offsets, types, units, order and way of leaving out what has no point.
///
/// Sources: ros-drivers/velodyne (velodyne_pointcloud, organize_cloud), ouster-lidar/ouster-ros
/// (point_type original), HesaiTechnology/HesaiLidar_ROS_2.0, Livox-SDK/livox_ros_driver2
/// (xfer_format 0); recordings of Aeva's Aeries II in HeLiPR and HeRCULES; Autoware's
/// documentation, "Point cloud pre-processing design".
enum class PointLayout {
  kRailcast,  ///< A frame's own fields, packed; organised, NaN where there is no point.
  kVelodyne,  ///< 22 bytes; a row for each firing of all channels, NaN where there is no point.
  kOuster,    ///< 48 bytes; organised from the highest channel down, a cloud for each return.
  kHesai,     ///< 26 bytes; points only; `timestamp` in seconds.
  kLivox,     ///< 26 bytes; points only; `timestamp` in nanoseconds.
  kAeva,      ///< 25 bytes; points only; `velocity`, positive = receding.
  kAutoware,  ///< 32 bytes; points only; XYZIRCAEDT, `time_stamp` in nanoseconds since the stamp.
};

}  // namespace railcast::ros

namespace railcast {

template <>
inline constexpr auto kEnumNames<ros::PointLayout> =
    std::to_array<EnumName<ros::PointLayout>>({{ros::PointLayout::kRailcast, "railcast"},
                                               {ros::PointLayout::kVelodyne, "velodyne"},
                                               {ros::PointLayout::kOuster, "ouster"},
                                               {ros::PointLayout::kHesai, "hesai"},
                                               {ros::PointLayout::kLivox, "livox"},
                                               {ros::PointLayout::kAeva, "aeva"},
                                               {ros::PointLayout::kAutoware, "autoware"}});

}  // namespace railcast

namespace railcast::ros {

/// How the points of clouds are stored.
struct CloudSpec {
  PointLayout layout = PointLayout::kRailcast;
  FieldSelection fields;  ///< For the layout `railcast` only.

  bool operator==(const CloudSpec&) const = default;
};

/// Parses what `--fields` says for messages: the name of a layout, "all", or a list of railcast's
/// fields.
/// @param has_velocity,has_track As FieldSelection takes them; frames without leave these fields
///   out.
/// @throws InputError as FieldSelection does, or "--fields: must contain x, y and z ...".
[[nodiscard]] CloudSpec ParseCloudSpec(std::string_view text,
                                       bool has_velocity = false,
                                       bool has_track = false);

/// The text that ParseCloudSpec() reads as this.
[[nodiscard]] std::string TextOf(const CloudSpec& spec);

/// How many clouds a frame becomes: one for each return of a firing, or one with all of them.
[[nodiscard]] std::uint32_t NumClouds(PointLayout layout, std::uint32_t num_returns);

/// Makes a frame's cloud, stamped with the frame's stamp.
/// @param frame_id Of the axes in which its points are.
/// @param channel_of_row The vendor's number, from 0, of each row's channel, which the layouts
///   `hesai` and `autoware` store; empty = counted from the highest.
/// @param cloud Less than NumClouds().
/// @throws InputError if the layout cannot hold the frame: Livox's and Aeva's have at most 256
///   lines, Aeva's needs velocities.
[[nodiscard]] PointCloud2 MakeCloud(const Frame& frame,
                                    const CloudSpec& spec,
                                    std::string frame_id,
                                    const std::vector<std::uint16_t>& channel_of_row = {},
                                    std::uint32_t cloud = 0);

/// The time of a message, which counts from simulation time 0.
[[nodiscard]] Time TimeOf(std::int64_t time_ns);

}  // namespace railcast::ros
