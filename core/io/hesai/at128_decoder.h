#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/io/hesai/at128_correction.h"
#include "core/io/hesai/hesai_packet.h"
#include "core/io/sensor_turn.h"
#include "core/io/turn_edit.h"
#include "railcast/lidar.h"

namespace railcast {

/// Bytes of an AT128's data packet: protocol 4.3, with number and signature.
inline constexpr std::size_t kAt128PacketSize = 1118;

/// What its checksums are of: the blocks, and the tail with the packet's number, behind which a
/// signature follows. HesaiLidar_SDK_2.0 (udp_protocol_v4_3.h) has their places. That they are
/// CRC-32/MPEG-2 of the body and of the tail say the manuals of two sensors whose packets are alike
/// but for functional safety between the two (QT128C2X and Pandar128E3X, 3.1.2).
inline constexpr std::array<HesaiCheckedBytes, 2> kAt128CheckedBytes = {{{12, 1042}, {1046, 1082}}};

/// The lasers of an AT128 with their firing times; azimuths, which a unit's file knows, are 0.
[[nodiscard]] std::vector<ChannelSpec> At128Channels(const At128Correction& correction);

/// Whether this begins as a data packet of an AT128 does.
[[nodiscard]] bool IsAt128Packet(std::span<const char> payload);

/// Turns the data packets of a Hesai AT128 into points. A turn is the sweep of one of its three
/// mirrors, which ends where the next one begins. Azimuths are those of the blocks by the unit's
/// correction file. Stamps are as HesaiDecoder's.
class At128Decoder {
 public:
  explicit At128Decoder(std::shared_ptr<const At128Correction> correction);

  /// As HesaiDecoder::Decode().
  [[nodiscard]] std::optional<std::string> Decode(std::span<const char> payload,
                                                  std::vector<SensorTurn>& turns);
  /// Returns the turn that no packet has completed yet, and starts a new one.
  [[nodiscard]] SensorTurn TakeUnfinished();

  /// Stores the returns of a firing in its packet.
  /// @pre The decoder has taken the packet.
  /// @returns Why the packet cannot state them; it is then unchanged.
  [[nodiscard]] std::optional<std::string> Store(const EditedReturns& returns,
                                                 const FiringPlace& place,
                                                 std::span<char> packet) const;
  /// Brings a packet's checksum up to what was stored in it.
  void Seal(std::span<char> packet) const;

 private:
  void AddColumn(std::span<const char> payload, std::size_t block, std::vector<SensorTurn>& turns);
  void AddPoint(const char* place, double unit_m, double block_deg, TurnPoint point);

  std::shared_ptr<const At128Correction> correction_;
  std::vector<std::uint16_t> rows_;
  std::uint32_t num_packets_{};
  std::optional<std::size_t> field_;  ///< Of the turn.
  SensorTurn turn_;
};

}  // namespace railcast
