#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/extras/packets/spinning/coded_return.h"
#include "core/extras/packets/spinning/sensor_turn.h"
#include "core/extras/packets/spinning/spinning_model.h"

namespace railcast {

/// Returns the intensity byte of a frame's intensity: percent, at most 255. NaN gives 0.
[[nodiscard]] std::uint8_t PercentByte(float intensity);

/// The CRC of Hesai's packets, CRC-32/MPEG-2.
[[nodiscard]] std::uint32_t HesaiCrc(std::span<const char> bytes);

/// Writes the checksums of a packet's bytes.
/// @pre The packet has its model's size.
void StoreChecksums(const SpinningModel& model, std::span<char> packet);

/// Whether a payload has the header of a model's packets.
[[nodiscard]] bool HasHeaderOf(const SpinningModel& model, std::span<const char> payload);

/// Returns why a payload is not a data packet of a model, as "rule (got value)", or nothing if it
/// is one.
[[nodiscard]] std::optional<std::string> RefusePacket(const SpinningModel& model,
                                                      std::span<const char> payload);

// All of these take a packet of the model.

[[nodiscard]] std::uint8_t ModeOf(const SpinningModel& model, std::span<const char> packet);
/// How many blocks hold a loop, with both returns.
[[nodiscard]] std::size_t BlocksInGroup(const SpinningModel& model, std::span<const char> packet);
[[nodiscard]] double UnitOf_m(const SpinningModel& model, std::span<const char> packet);
/// In 0.01 deg.
[[nodiscard]] std::uint16_t AzimuthOf(const SpinningModel& model,
                                      std::span<const char> packet,
                                      std::size_t block);
/// The loop of a block.
[[nodiscard]] std::size_t LoopOf(const SpinningModel& model,
                                 std::span<const char> packet,
                                 std::size_t block);
/// The first blocks of the loops of a packet, but for those that are zeros. Where there is a flag,
/// or blocks have none, zeros may be a loop that saw nothing at azimuth 0, if others are near that.
[[nodiscard]] std::vector<std::size_t> LoopsIn(const SpinningModel& model,
                                               std::span<const char> packet);
/// Returns the median step from loop to loop, so that a gap between two turns or the end of
/// an azimuth window does not affect it: of two steps, one of which is such a gap, the other.
[[nodiscard]] std::int64_t UsualStep(const SpinningModel& model,
                                     std::span<const char> packet,
                                     const std::vector<std::size_t>& loops);
[[nodiscard]] PacketMark MarkOf(const SpinningModel& model, std::span<const char> packet);
/// Returns the time that a packet states, since 1970-01-01, or since the start of the day if its
/// clock has no date.
/// @pre The packets have a date.
[[nodiscard]] std::int64_t StatedNs(const SpinningModel& model, std::span<const char> packet);

/// What a packet says at its end.
struct PacketEnd {
  std::int64_t time_ns{};  ///< The time that the packet states, since 1970-01-01.
  std::uint16_t speed_rpm{};
  std::uint32_t sequence{};  ///< Number of the packet.
};

/// A data packet under construction. What a simulated sensor does not have (temperatures, IMU,
/// signature, reserved bytes) is 0.
class SpinningPacket {
 public:
  /// @param model Must outlive the packet.
  SpinningPacket(const SpinningModel& model, std::uint8_t mode);

  /// Begins a block, in which no laser has fired.
  /// @param loop Of the model's.
  /// @param azimuth In 0.01 deg. @param fine In 1/256 of that, where packets say so.
  void BeginBlock(std::size_t block,
                  std::size_t loop,
                  std::uint16_t azimuth,
                  std::uint8_t fine = 0);
  /// @param place As SpinningModel::ReturnPlace().
  void SetReturn(std::size_t place, const CodedReturn& coded) {
    StoreCoded(coded, bytes_.data() + place);
  }

  /// Writes the end and the checksums.
  /// @returns The packet, valid until its next change.
  /// @pre All blocks were begun.
  [[nodiscard]] std::span<const char> Close(const PacketEnd& end);

 private:
  void WriteHeader(std::uint8_t mode);
  void WriteTime(std::int64_t time_ns);
  void WriteSafety(std::int64_t time_ns);

  const SpinningModel* model_;
  std::vector<char> bytes_;
};

}  // namespace railcast
