#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/io/coded_return.h"
#include "core/io/hesai/hesai_model.h"

namespace railcast {

/// Returns the intensity byte of a frame's intensity: percent, at most 255. NaN gives 0.
[[nodiscard]] std::uint8_t PercentByte(float intensity);

/// What a packet says at its end.
struct HesaiEnd {
  std::int64_t time_ns{};  ///< That the packet states, since 1970-01-01.
  std::uint16_t speed_rpm{};
  std::uint32_t sequence{};  ///< Number of the packet.
};

/// The CRC of Hesai's packets, CRC-32/MPEG-2.
[[nodiscard]] std::uint32_t HesaiCrc(std::span<const char> bytes);

/// Bytes of a packet, from begin to end, behind which the checksum of them stands.
struct HesaiCheckedBytes {
  std::size_t begin{};
  std::size_t end{};
};

/// Those of a layout; none if its packets have no checksums.
[[nodiscard]] std::vector<HesaiCheckedBytes> HesaiCheckedBytesOf(const HesaiLayout& layout);

/// Writes the checksums of a packet's bytes.
/// @pre The packet has all of them, and what follows.
void StoreHesaiChecksums(std::span<const HesaiCheckedBytes> checked, std::span<char> packet);

/// Whether the checksums that a packet states are those of its bytes.
/// @pre The packet has all of them, and what follows.
[[nodiscard]] bool HasRightHesaiChecksums(std::span<const HesaiCheckedBytes> checked,
                                          std::span<const char> packet);

/// Returns the time that a packet states, since 1970-01-01, or since the start of the day if it has
/// no date.
/// @param year_zero As HesaiModel::year_zero.
/// @pre The microseconds are less than a second.
[[nodiscard]] std::int64_t HesaiStatedNs(const HesaiTail& tail,
                                         int year_zero,
                                         std::span<const char> packet);

/// A data packet of a Hesai sensor under construction. What a simulated sensor does not have
/// (temperatures, IMU, signature, reserved bytes) is 0.
class HesaiPacket {
 public:
  /// @param model Must outlive the packet.
  HesaiPacket(const HesaiModel& model, std::uint8_t mode);

  /// Begins a block, in which no laser has fired.
  /// @param loop Of the model's.
  /// @param azimuth In 0.01 deg.
  void BeginBlock(std::size_t block, std::size_t loop, std::uint16_t azimuth);
  void SetReturn(std::size_t block, std::size_t laser, const CodedReturn& coded);

  /// Writes the end and the checksums.
  /// @returns The packet, valid until its next change.
  /// @pre All blocks were begun.
  [[nodiscard]] std::span<const char> Close(const HesaiEnd& end);

 private:
  void WriteHeader(std::uint8_t mode);
  void WriteTime(std::int64_t time_ns);
  void WriteSafety(std::int64_t time_ns);

  const HesaiModel* model_;
  std::vector<char> bytes_;
};

}  // namespace railcast
