#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/io/hesai/at128_correction.h"
#include "core/io/sensor_turn.h"
#include "railcast/lidar.h"

namespace railcast {

/// Bytes of an AT128's data packet: protocol 4.3, with number and signature.
inline constexpr std::size_t kAt128PacketSize = 1118;

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

 private:
  void AddColumn(std::span<const char> payload, std::size_t block, std::vector<SensorTurn>& turns);
  void AddPoint(const char* place, double unit_m, double block_deg, TurnPoint point);

  std::shared_ptr<const At128Correction> correction_;
  std::vector<std::uint16_t> rows_;
  std::optional<std::size_t> field_;  ///< Of the turn.
  SensorTurn turn_;
};

}  // namespace railcast
