#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/io/coded_return.h"
#include "core/io/hesai/hesai_model.h"

namespace railcast {

/// What a packet says at its end.
struct HesaiEnd {
  std::int64_t time_ns{};  ///< That the packet states, since 1970-01-01.
  std::uint16_t speed_rpm{};
  std::uint32_t sequence{};  ///< Number of the packet.
};

/// The CRC of Hesai's packets, CRC-32/MPEG-2.
[[nodiscard]] std::uint32_t HesaiCrc(std::span<const char> bytes);

/// Writes the checksums of the bytes that a packet has, if its layout has any.
/// @pre The packet has the layout's size.
void StoreHesaiChecksums(const HesaiLayout& layout, std::span<char> packet);

/// Whether the checksums that a packet states are those of its bytes; true if it has none.
/// @pre The packet has the layout's size.
[[nodiscard]] bool HasRightHesaiChecksums(const HesaiLayout& layout, std::span<const char> packet);

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
