#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/io/field_layout.h"
#include "core/io/hesai/pandar64_packet.h"
#include "core/io/velodyne/velodyne_packet.h"

namespace railcast {

/// Returns a packet with blocks at azimuths 100, 120, ... (in 0.01 deg). Channel 0 measures 1 m at
/// 50 %; all other channels have no return.
inline std::vector<char> MadePacket(std::uint8_t mode = kPandar64Strongest) {
  std::vector<char> packet(kPandar64PacketSize, '\0');
  StoreAt<std::uint16_t>(packet.data(), kHesaiFlag);
  packet[2] = 64;
  packet[3] = 6;
  packet[5] = 4;
  const std::size_t in_group = mode == kPandar64LastAndStrongest ? 2 : 1;
  for (std::size_t block = 0; block < 6; ++block) {
    char* const place = packet.data() + kPandar64HeaderSize + block * kPandar64BlockSize;
    StoreAt<std::uint16_t>(place, 100 + 20 * (block / in_group));
    StoreAt<std::uint16_t>(place + 2, 250);
    place[4] = 50;
  }
  StoreAt<std::uint32_t>(packet.data() + kPandar64TimePlace, 500'000);
  packet[kPandar64ModePlace] = static_cast<char>(mode);
  const std::array<std::uint8_t, 6> date = {70, 1, 2, 0, 0, 3};  // 1970-01-02 00:00:03
  std::copy(date.begin(), date.end(), packet.begin() + kPandar64DatePlace);
  return packet;
}

}  // namespace railcast
