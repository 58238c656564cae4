#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "core/extras/packets/spinning/spinning_model.h"
#include "core/extras/packets/spinning/spinning_packet.h"
#include "core/extras/packets/velodyne/velodyne_packet.h"
#include "core/io/field_layout.h"

namespace railcast {

/// All models of Hesai that need no more than their packets.
inline const std::vector<SpinningModel>& HesaiModels() {
  static const std::vector<SpinningModel> models = [] {
    std::vector<SpinningModel> found = SpinningModels();
    std::erase_if(
        found, [](const SpinningModel& model) { return !model.is_read || model.date_place == 0; });
    return found;
  }();
  return models;
}

// The models of which the tests know more.
inline const SpinningModel& Pandar64Model() {
  return *FindSpinningModel("pandar64");
}
inline const SpinningModel& Xt32Model() {
  return *FindSpinningModel("xt32");
}
inline const SpinningModel& Qt128Model() {
  return *FindSpinningModel("qt128");
}

/// The model of a protocol that has packets of this size: those of Pandar40P may lack their number.
inline const SpinningModel& ModelOfSize(std::string_view protocol, std::size_t packet_size) {
  return *std::ranges::find_if(HesaiModels(), [&](const SpinningModel& model) {
    return model.protocol == protocol && model.packet_size == packet_size;
  });
}

// Return modes.
inline constexpr std::uint8_t kMadeStrongest = 0x37;
inline constexpr std::uint8_t kMadeDual = 0x39;  ///< Last and strongest.

/// The place of a laser's distance in a packet of this sensor.
inline std::size_t DistancePlace(const SpinningModel& model, std::size_t block, std::size_t laser) {
  return model.ReturnPlace(block, laser);
}

/// Returns a packet, with a header, with blocks at azimuths 100, 120, ... (in 0.01 deg), at half a
/// second past 2000-01-02 00:00:03 and 600 revolutions per minute. Laser 0 measures 1 m at 50 %;
/// all others have no return.
inline std::vector<char> MadePacket(const SpinningModel& model = Pandar64Model(),
                                    std::uint8_t mode = kMadeStrongest) {
  std::vector<char> packet(model.packet_size, '\0');
  StoreAt<std::uint16_t>(packet.data(), kHesaiFlag);
  std::ranges::copy(model.version, packet.begin() + 2);
  packet[model.lasers_place] = static_cast<char>(model.lasers);
  packet[model.blocks_place] = static_cast<char>(model.blocks);
  packet[model.unit_place] = 4;
  const std::size_t in_group = mode == kMadeDual ? 2 : 1;
  for (std::size_t block = 0; block < model.blocks; ++block) {
    char* const place = packet.data() + DistancePlace(model, block, 0);
    StoreAt<std::uint16_t>(place - 2, 100 + 20 * (block / in_group));
    StoreAt<std::uint16_t>(place, 250);
    place[2] = 50;
  }
  StoreAt<std::uint32_t>(packet.data() + model.time_place, 500'000);
  StoreAt<std::uint16_t>(packet.data() + model.speed_place, 600);
  packet[model.mode_place] = static_cast<char>(mode);
  const std::array<std::uint8_t, 6> date = {100, 1, 2, 0, 0, 3};
  std::ranges::copy(date, packet.begin() + static_cast<std::ptrdiff_t>(model.date_place));
  StoreChecksums(model, packet);
  return packet;
}

/// The same packet of a Pandar64 with this number of its own, so that it is another one.
inline std::vector<char> NumberedPacket(std::uint32_t number) {
  std::vector<char> packet = MadePacket();
  StoreAt<std::uint32_t>(packet.data() + Pandar64Model().sequence_place, number);
  return packet;
}

}  // namespace railcast
