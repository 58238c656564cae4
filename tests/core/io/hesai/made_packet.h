#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "core/io/field_layout.h"
#include "core/io/hesai/hesai_model.h"
#include "core/io/hesai/hesai_packet.h"
#include "core/io/velodyne/velodyne_packet.h"

namespace railcast {

// The models of which the tests know more.
inline const HesaiModel& Pandar64Model() {
  return *FindHesaiModel("pandar64");
}
inline const HesaiModel& Xt32Model() {
  return *FindHesaiModel("xt32");
}
inline const HesaiModel& Qt128Model() {
  return *FindHesaiModel("qt128");
}

/// The model of a protocol that has packets of this size: those of Pandar40P may lack their number.
inline const HesaiModel& ModelOfSize(std::string_view protocol, std::size_t packet_size) {
  return *std::ranges::find_if(HesaiModels(), [&](const HesaiModel& model) {
    return model.protocol == protocol && model.layout.packet_size == packet_size;
  });
}

// Return modes.
inline constexpr std::uint8_t kMadeStrongest = 0x37;
inline constexpr std::uint8_t kMadeDual = 0x39;  ///< Last and strongest.

/// The place of a laser's distance in a packet of this sensor.
inline std::size_t DistancePlace(const HesaiModel& model, std::size_t block, std::size_t laser) {
  const HesaiLayout& layout = model.layout;
  return layout.BlockPlace(block) + layout.block_head_size() + laser * layout.return_size;
}

/// Returns a packet, with a header, with blocks at azimuths 100, 120, ... (in 0.01 deg), at half a
/// second past 2000-01-02 00:00:03 and 600 revolutions per minute. Laser 0 measures 1 m at 50 %;
/// all others have no return.
inline std::vector<char> MadePacket(const HesaiModel& model = Pandar64Model(),
                                    std::uint8_t mode = kMadeStrongest) {
  const HesaiLayout& layout = model.layout;
  std::vector<char> packet(layout.packet_size, '\0');
  StoreAt<std::uint16_t>(packet.data(), kHesaiFlag);
  const HesaiHeader& header = *layout.header;
  if (header.version) std::ranges::copy(*header.version, packet.begin() + 2);
  packet[header.lasers_place] = static_cast<char>(layout.lasers);
  packet[header.blocks_place] = static_cast<char>(layout.blocks);
  packet[header.unit_place] = 4;
  const std::size_t in_group = mode == kMadeDual ? 2 : 1;
  for (std::size_t block = 0; block < layout.blocks; ++block) {
    char* const place = packet.data() + DistancePlace(model, block, 0);
    StoreAt<std::uint16_t>(place - 2, 100 + 20 * (block / in_group));
    StoreAt<std::uint16_t>(place, 250);
    place[2] = 50;
  }
  StoreAt<std::uint32_t>(packet.data() + layout.tail.time_place, 500'000);
  StoreAt<std::uint16_t>(packet.data() + layout.tail.speed_place, 600);
  packet[layout.tail.mode_place] = static_cast<char>(mode);
  const std::array<std::uint8_t, 6> date = {100, 1, 2, 0, 0, 3};
  std::ranges::copy(date, packet.begin() + static_cast<std::ptrdiff_t>(layout.tail.date_place));
  StoreHesaiChecksums(HesaiCheckedBytesOf(layout), packet);
  return packet;
}

}  // namespace railcast
