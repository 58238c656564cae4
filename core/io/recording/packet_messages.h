#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/io/ros/geometry_messages.h"

// Messages in which ROS drivers record the packets of their sensors, unchanged. VisitFields() as in
// geometry_messages.h.

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

struct StringMessage {
  static constexpr std::string_view kName = "std_msgs/msg/String";
  std::string data;

  static void VisitFields(auto& self, auto&& visit) { visit("data", self.data); }
};

}  // namespace railcast::ros
