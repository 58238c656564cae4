#include "core/extras/ros/recording/message_packets.h"

#include <algorithm>
#include <array>
#include <span>
#include <string_view>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/units.h"
#include "core/extras/ros/messages/cdr.h"
#include "core/extras/ros/recording/packet_messages.h"

namespace railcast {
namespace {

/// Puts together the packets of a message.
class PacketList {
 public:
  explicit PacketList(std::span<const std::byte> message) : message_(message) {}

  template <typename Data>
  void Add(const ros::Time& stamp, const Data& data, std::size_t size) {
    const std::span bytes = std::as_bytes(std::span(data)).first(size);
    // Messages hold the bytes of packets as they are, in the packets' order.
    const auto found = std::search(message_.begin() + static_cast<std::ptrdiff_t>(end_of_last_),
                                   message_.end(), bytes.begin(), bytes.end());
    const auto place = static_cast<std::size_t>(found - message_.begin());
    end_of_last_ = place + size;
    const auto* const begin = reinterpret_cast<const char*>(bytes.data());
    packets.push_back({{begin, begin + size}, stamp.sec * kNsPerS + stamp.nanosec, place});
  }

  std::vector<MessagePacket> packets;

 private:
  std::span<const std::byte> message_;
  std::size_t end_of_last_{};
};

std::vector<MessagePacket> PandarPackets(const bag::BagMessage& message) {
  PacketList list(message.data);
  for (const auto& packet : ros::FromCdr<ros::PandarScan>(message.data).packets) {
    if (packet.size > packet.data.size()) {
      throw InputError("size: must be at most " + NumberText(packet.data.size()) +
                       Got(packet.size));
    }
    list.Add(packet.stamp, packet.data, packet.size);
  }
  return std::move(list.packets);
}

template <typename Scan>
std::vector<MessagePacket> PacketsOfScan(const bag::BagMessage& message) {
  PacketList list(message.data);
  for (const auto& packet : ros::FromCdr<Scan>(message.data).packets) {
    list.Add(packet.stamp, packet.data, packet.data.size());
  }
  return std::move(list.packets);
}

std::vector<MessagePacket> OusterPackets(const bag::BagMessage& message) {
  PacketList list(message.data);
  const auto packet = ros::FromCdr<ros::OusterPacketMessage>(message.data);
  list.Add({}, packet.buf, packet.buf.size());
  list.packets.front().time_ns = message.time_ns;
  return std::move(list.packets);
}

struct PacketType {
  std::string_view name;
  PacketsOfMessage packets_of;
};

constexpr std::array<PacketType, 4> kPacketTypes = {
    {{ros::PandarScan::kName, PandarPackets},
     {ros::NebulaPackets::kName, PacketsOfScan<ros::NebulaPackets>},
     {ros::VelodyneScan::kName, PacketsOfScan<ros::VelodyneScan>},
     {ros::OusterPacketMessage::kName, OusterPackets}}};

}  // namespace

PacketsOfMessage FindPacketsOf(const std::string& type) {
  const auto found = std::ranges::find(kPacketTypes, type, &PacketType::name);
  return found == kPacketTypes.end() ? nullptr : found->packets_of;
}

}  // namespace railcast
