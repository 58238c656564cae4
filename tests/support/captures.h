#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "core/extras/packets/pcap/pcap_reader.h"
#include "core/extras/packets/pcap/pcap_writer.h"
#include "core/io/datagrams.h"
#include "core/scenario/sensors.h"

namespace railcast {

/// Writes a capture of these datagrams.
/// @return `file`.
inline std::filesystem::path WriteDatagrams(const std::filesystem::path& file,
                                            const Datagrams& datagrams,
                                            std::uint16_t data_port = kVelodyneDataPort,
                                            std::uint16_t position_port = kVelodynePositionPort,
                                            bool is_ipv6 = false) {
  PcapWriter writer(file, data_port, position_port, is_ipv6);
  writer.Write(datagrams, datagrams.items);
  writer.Finish();
  return file;
}

/// Returns the bytes of each datagram in a capture.
[[nodiscard]] inline std::vector<std::vector<char>> PacketsInCapture(
    const std::filesystem::path& capture) {
  PcapReader reader(capture);
  std::vector<std::vector<char>> packets;
  while (const auto datagram = reader.Next()) {
    packets.emplace_back(datagram->payload.begin(), datagram->payload.end());
  }
  return packets;
}

}  // namespace railcast
