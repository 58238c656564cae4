#pragma once

#include <cstddef>
#include <deque>
#include <string>

#include "core/io/pcap/pcap_reader.h"
#include "core/io/recording/capture_sensor.h"

namespace railcast {

/// Makes turns of a sensor's datagrams.
class TurnReader {
 public:
  /// @param source Names the recording in messages.
  TurnReader(CaptureSensor sensor, std::string source);

  /// Takes the next datagram, which holds one packet, several that were captured as one, or what is
  /// none of the sensor's, and appends the turns that it completes.
  /// @returns Number of packets that the decoder was given. They follow each other from the begin
  ///   of the payload, each of the sensor's packet size but perhaps the last.
  /// @throws InputError if a datagram of several ends within a packet.
  std::size_t Take(const CapturedDatagram& datagram, std::deque<SensorTurn>& turns);
  /// Appends the turn that no packet has completed.
  void End(std::deque<SensorTurn>& turns);

  [[nodiscard]] const CaptureSensor& sensor() const { return sensor_; }
  /// Number of packets so far whose checksum is wrong.
  [[nodiscard]] std::size_t num_damaged() const { return num_damaged_; }

 private:
  /// Returns whether the packet belongs to the sensor.
  [[nodiscard]] bool TakePacket(std::span<const char> packet, std::vector<SensorTurn>& turns);

  CaptureSensor sensor_;
  std::string source_;
  std::size_t num_damaged_{};
};

}  // namespace railcast
