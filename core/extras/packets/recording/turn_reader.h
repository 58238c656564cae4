#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "core/extras/packets/pcap/pcap_reader.h"
#include "core/extras/packets/recording/capture_sensor.h"
#include "core/extras/packets/recording/packet_order.h"

namespace railcast {

/// Makes turns of a sensor's datagrams, whose packets it puts in order. All that it does not take
/// is counted.
class TurnReader {
 public:
  /// @param source Names the recording in messages.
  TurnReader(CaptureSensor sensor, std::string source);

  /// Takes the next datagram, which holds one packet, several that were captured as one, or what is
  /// none of the sensor's, and appends the turns that are complete.
  /// @param turns Null where packets are but counted: they are put in order, and not decoded.
  /// @param decoded Receives the packets that the decoder was given, if that is wanted.
  void Take(const CapturedDatagram& datagram,
            std::deque<SensorTurn>* turns,
            std::deque<OrderedPacket>* decoded = nullptr);
  /// Appends the turns that are left, the last of which no packet has completed.
  void End(std::deque<SensorTurn>* turns, std::deque<OrderedPacket>* decoded = nullptr);

  [[nodiscard]] const CaptureSensor& sensor() const { return sensor_; }
  /// Number of datagrams so far.
  [[nodiscard]] std::uint64_t num_datagrams() const { return num_datagrams_; }
  /// As PacketOrder::first_held_datagram().
  [[nodiscard]] std::optional<std::uint64_t> first_held_datagram() const {
    return order_.first_held_datagram();
  }

  // What became of packets and datagrams so far. Of those lost, damaged and refused ones are none.
  [[nodiscard]] std::size_t num_taken() const { return num_taken_; }
  [[nodiscard]] PacketTally lost() const;
  [[nodiscard]] const PacketOrder& order() const { return order_; }
  [[nodiscard]] const PacketTally& damaged() const { return damaged_; }
  [[nodiscard]] const PacketTally& refused() const { return refused_; }
  [[nodiscard]] std::vector<Remark> remarks() const;

 private:
  void CountOther(const CapturedDatagram& datagram);
  void CountUnknown(const CapturedDatagram& datagram);
  void CountRefused(const CapturedDatagram& datagram, const std::string& why);
  void Decode(std::deque<SensorTurn>* turns, std::deque<OrderedPacket>* decoded);

  CaptureSensor sensor_;
  std::string source_;
  PacketOrder order_;
  std::uint64_t num_datagrams_{};
  std::size_t num_taken_{};
  PacketTally damaged_, refused_, incomplete_, empty_blocks_, unknown_, others_;
};

/// Reads all datagrams of a place, and returns a reader of each of its sensors, which has counted
/// them.
/// @throws InputError as FindSensors().
[[nodiscard]] std::vector<TurnReader> CountPackets(const DatagramPlace& place);

/// The ports that a sensor's packets go to: "2368", "2368, 2369".
[[nodiscard]] std::string PortsText(const CaptureSensor& sensor);

}  // namespace railcast
