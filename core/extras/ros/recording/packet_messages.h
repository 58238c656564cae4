#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/extras/ros/messages/geometry_messages.h"

// Messages in which ROS drivers record the packets of their sensors, unchanged, and those of Livox,
// which hold points. `kFields` as in geometry_messages.h.

namespace railcast::ros {

/// The packet of Hesai's and nebula's older drivers.
struct PandarPacket {
  static constexpr std::string_view kName = "pandar_msgs/msg/PandarPacket";
  static constexpr std::array kFields = {"stamp", "data", "size"};
  Time stamp;
  std::array<std::uint8_t, 1500> data{};
  std::uint32_t size{};  ///< How many of the data are in use.
};

struct PandarScan {
  static constexpr std::string_view kName = "pandar_msgs/msg/PandarScan";
  static constexpr std::array kFields = {"header", "packets"};
  Header header;
  std::vector<PandarPacket> packets;
};

/// The packet of nebula's drivers.
struct NebulaPacket {
  static constexpr std::string_view kName = "nebula_msgs/msg/NebulaPacket";
  static constexpr std::array kFields = {"stamp", "data"};
  Time stamp;
  std::vector<std::uint8_t> data;
};

struct NebulaPackets {
  static constexpr std::string_view kName = "nebula_msgs/msg/NebulaPackets";
  static constexpr std::array kFields = {"header", "packets"};
  Header header;
  std::vector<NebulaPacket> packets;
};

struct VelodynePacketMessage {
  static constexpr std::string_view kName = "velodyne_msgs/msg/VelodynePacket";
  static constexpr std::array kFields = {"stamp", "data"};
  Time stamp;
  std::array<std::uint8_t, 1206> data{};
};

struct VelodyneScan {
  static constexpr std::string_view kName = "velodyne_msgs/msg/VelodyneScan";
  static constexpr std::array kFields = {"header", "packets"};
  Header header;
  std::vector<VelodynePacketMessage> packets;
};

struct OusterPacketMessage {
  static constexpr std::string_view kName = "ouster_sensor_msgs/msg/PacketMsg";
  static constexpr std::array kFields = {"buf"};
  std::vector<std::uint8_t> buf;
};

/// A point of Livox's drivers.
struct LivoxPoint {
  static constexpr std::string_view kName = "livox_ros_driver2/msg/CustomPoint";
  static constexpr std::array kFields = {"offset_time",  "x",   "y",   "z",
                                         "reflectivity", "tag", "line"};
  std::uint32_t offset_time{};  ///< Nanoseconds since LivoxCloud::timebase.
  float x{}, y{}, z{};          ///< Metres; all 0 where nothing came back.
  std::uint8_t reflectivity{};
  std::uint8_t tag{};
  std::uint8_t line{};
};

struct LivoxCloud {
  static constexpr std::string_view kName = "livox_ros_driver2/msg/CustomMsg";
  static constexpr std::array kFields = {"header",   "timebase", "point_num",
                                         "lidar_id", "rsvd",     "points"};
  /// The same message of the older drivers.
  static constexpr std::array<std::string_view, 2> kOlderNames = {"livox_ros_driver/msg/CustomMsg",
                                                                  "livox_interfaces/msg/CustomMsg"};
  Header header;
  std::uint64_t timebase{};  ///< Nanoseconds.
  std::uint32_t point_num{};
  std::uint8_t lidar_id{};
  std::array<std::uint8_t, 3> rsvd{};
  std::vector<LivoxPoint> points;
};

struct StringMessage {
  static constexpr std::string_view kName = "std_msgs/msg/String";
  static constexpr std::array kFields = {"data"};
  std::string data;
};

}  // namespace railcast::ros
