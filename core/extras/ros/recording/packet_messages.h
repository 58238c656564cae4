#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/extras/ros/messages/geometry_messages.h"

// Messages in which ROS drivers record the packets of their sensors, unchanged, and those of Livox,
// which hold points. VisitFields() as in geometry_messages.h.

namespace railcast::ros {

/// Of Hesai's and nebula's older drivers.
struct PandarPacket {
  static constexpr std::string_view kName = "pandar_msgs/msg/PandarPacket";
  Time stamp;
  std::array<std::uint8_t, 1500> data{};
  std::uint32_t size{};  ///< How many of the data are in use.

  static void VisitFields(auto& self, auto&& visit) {
    visit("stamp", self.stamp);
    visit("data", self.data);
    visit("size", self.size);
  }
};

struct PandarScan {
  static constexpr std::string_view kName = "pandar_msgs/msg/PandarScan";
  Header header;
  std::vector<PandarPacket> packets;

  static void VisitFields(auto& self, auto&& visit) {
    visit("header", self.header);
    visit("packets", self.packets);
  }
};

/// Of nebula's drivers.
struct NebulaPacket {
  static constexpr std::string_view kName = "nebula_msgs/msg/NebulaPacket";
  Time stamp;
  std::vector<std::uint8_t> data;

  static void VisitFields(auto& self, auto&& visit) {
    visit("stamp", self.stamp);
    visit("data", self.data);
  }
};

struct NebulaPackets {
  static constexpr std::string_view kName = "nebula_msgs/msg/NebulaPackets";
  Header header;
  std::vector<NebulaPacket> packets;

  static void VisitFields(auto& self, auto&& visit) {
    visit("header", self.header);
    visit("packets", self.packets);
  }
};

struct VelodynePacketMessage {
  static constexpr std::string_view kName = "velodyne_msgs/msg/VelodynePacket";
  Time stamp;
  std::array<std::uint8_t, 1206> data{};

  static void VisitFields(auto& self, auto&& visit) {
    visit("stamp", self.stamp);
    visit("data", self.data);
  }
};

struct VelodyneScan {
  static constexpr std::string_view kName = "velodyne_msgs/msg/VelodyneScan";
  Header header;
  std::vector<VelodynePacketMessage> packets;

  static void VisitFields(auto& self, auto&& visit) {
    visit("header", self.header);
    visit("packets", self.packets);
  }
};

struct OusterPacketMessage {
  static constexpr std::string_view kName = "ouster_sensor_msgs/msg/PacketMsg";
  std::vector<std::uint8_t> buf;

  static void VisitFields(auto& self, auto&& visit) { visit("buf", self.buf); }
};

/// A point of Livox's drivers.
struct LivoxPoint {
  static constexpr std::string_view kName = "livox_ros_driver2/msg/CustomPoint";
  std::uint32_t offset_time{};  ///< Nanoseconds since LivoxCloud::timebase.
  float x{}, y{}, z{};          ///< Metres; all 0 where nothing came back.
  std::uint8_t reflectivity{};
  std::uint8_t tag{};
  std::uint8_t line{};

  static void VisitFields(auto& self, auto&& visit) {
    visit("offset_time", self.offset_time);
    visit("x", self.x);
    visit("y", self.y);
    visit("z", self.z);
    visit("reflectivity", self.reflectivity);
    visit("tag", self.tag);
    visit("line", self.line);
  }
};

struct LivoxCloud {
  static constexpr std::string_view kName = "livox_ros_driver2/msg/CustomMsg";
  /// The same message of the older drivers.
  static constexpr std::array<std::string_view, 2> kOlderNames = {"livox_ros_driver/msg/CustomMsg",
                                                                  "livox_interfaces/msg/CustomMsg"};
  Header header;
  std::uint64_t timebase{};  ///< Nanoseconds.
  std::uint32_t point_num{};
  std::uint8_t lidar_id{};
  std::array<std::uint8_t, 3> rsvd{};
  std::vector<LivoxPoint> points;

  static void VisitFields(auto& self, auto&& visit) {
    visit("header", self.header);
    visit("timebase", self.timebase);
    visit("point_num", self.point_num);
    visit("lidar_id", self.lidar_id);
    visit("rsvd", self.rsvd);
    visit("points", self.points);
  }
};

struct StringMessage {
  static constexpr std::string_view kName = "std_msgs/msg/String";
  std::string data;

  static void VisitFields(auto& self, auto&& visit) { visit("data", self.data); }
};

}  // namespace railcast::ros
