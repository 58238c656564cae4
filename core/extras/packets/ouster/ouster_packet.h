#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/scenario/ouster_metadata.h"

namespace railcast {

// Packets of Ouster's sensors, little-endian (Ouster, firmware user manual, "lidar data packet
// format"; ouster-lidar/ouster-sdk, parsing.cpp):
//   header of 32 bytes, columns, footer of 32 bytes of which the last 8 are a checksum.
// LEGACY packets have neither header nor footer, but a status behind each column.

inline constexpr std::size_t kOusterImuPacketSize = 48;
/// Ticks of the encoder in a turn of the rotor.
inline constexpr std::uint32_t kOusterTicks = 90'112;

/// The header of a packet; LEGACY packets have but the frame's number.
struct OusterHeader {
  std::uint16_t packet_type = 1;  ///< 1: lidar data.
  std::uint32_t frame_id{};       ///< 16 bits, and 32 in a header of functional safety.
  std::uint32_t initialization_id{};
  std::uint64_t serial_number{};  ///< 40 bits.
  std::uint8_t alert_flags{};
  std::uint8_t shutdown_countdown_s{};
  std::uint8_t shot_limiting_countdown_s{};
  std::uint8_t thermal_shutdown{};  ///< 4 bits; 1: the sensor will switch itself off.
  std::uint8_t shot_limiting{};     ///< 4 bits; not 0: the lasers fire with less power.

  bool operator==(const OusterHeader&) const = default;
};

/// What all pixels of a column have in common.
struct OusterColumn {
  std::uint64_t time_ns{};         ///< By the sensor's clock.
  std::uint16_t measurement_id{};  ///< Number of the column in the turn.
  bool is_valid{};                 ///< Whether it was measured.

  bool operator==(const OusterColumn&) const = default;
};

struct OusterReturn {
  std::uint32_t range_mm{};  ///< From the rotor's axis on; 0: none.
  std::uint8_t flags{};      ///< Profile-dependent.
  /// As of velodyne_packet.h's reflectivity bytes, unless OusterMetadata::has_wide_reflectivity.
  std::uint16_t reflectivity{};
  std::uint16_t signal{};  ///< Photons; 0 in profiles without it.

  bool operator==(const OusterReturn&) const = default;
};

struct OusterPixel {
  std::array<OusterReturn, 2> returns{};  ///< The second is empty in profiles with one.
  std::uint16_t
      near_ir{};  ///< Photons of the background; a multiple of 16 in profiles of low rate.

  bool operator==(const OusterPixel&) const = default;
};

/// Where the fields of a sensor's packets stand.
class OusterLayout {
 public:
  explicit OusterLayout(const OusterMetadata& metadata);

  [[nodiscard]] std::size_t packet_size() const { return packet_size_; }
  [[nodiscard]] std::size_t num_columns() const { return num_columns_; }
  [[nodiscard]] std::size_t num_pixels() const { return num_pixels_; }
  [[nodiscard]] bool is_legacy() const { return profile_ == OusterProfile::kLegacy; }
  [[nodiscard]] bool is_dual() const { return IsDualProfile(profile_); }
  [[nodiscard]] std::size_t num_returns() const { return is_dual() ? 2 : 1; }
  /// Whether pixels state the photons of their returns.
  [[nodiscard]] bool has_signal() const { return !has_low_rate(); }
  /// Whether packets may have a checksum: those of LEGACY and of functional safety have none.
  [[nodiscard]] bool may_have_checksum() const { return !is_legacy() && !has_fusa_header_; }
  /// Numbers of frames are counted up to this one.
  [[nodiscard]] std::uint32_t last_frame_id() const {
    return has_fusa_header_ ? 0xFFFFFFFFU : 0xFFFFU;
  }
  /// Ranges are multiples of this, and at most `most_range_mm()`.
  [[nodiscard]] std::uint32_t range_unit_mm() const { return has_low_rate() ? 8 : 1; }
  [[nodiscard]] std::uint32_t most_range_mm() const;

  // All of these take a whole packet, and numbers below num_columns() and num_pixels().
  [[nodiscard]] OusterHeader HeaderOf(std::span<const char> packet) const;
  [[nodiscard]] OusterColumn ColumnOf(std::span<const char> packet, std::size_t column) const;
  [[nodiscard]] OusterPixel PixelOf(std::span<const char> packet,
                                    std::size_t column,
                                    std::size_t pixel) const {
    return PixelAt(packet, PlaceOfPixel(column, pixel));
  }
  /// The byte of the packet at which a pixel begins.
  [[nodiscard]] std::size_t PlaceOfPixel(std::size_t column, std::size_t pixel) const {
    return PlaceOfColumn(column) + column_header_size_ + pixel * pixel_size_;
  }
  /// @param place As PlaceOfPixel().
  [[nodiscard]] OusterPixel PixelAt(std::span<const char> packet, std::size_t place) const;
  void StorePixel(const OusterPixel& pixel, std::size_t place, std::span<char> packet) const;
  void Store(const OusterHeader& header, std::span<char> packet) const;
  /// The rotor's angle at a column of a LEGACY packet, kOusterTicks to a turn.
  [[nodiscard]] std::uint32_t EncoderTicksOf(std::span<const char> packet,
                                             std::size_t column) const;
  /// @param encoder_ticks As above.
  /// @param frame_id Of LEGACY packets.
  void Store(const OusterColumn& column,
             std::size_t place,
             std::uint32_t frame_id,
             std::uint32_t encoder_ticks,
             std::span<char> packet) const;
  void Store(const OusterPixel& pixel,
             std::size_t column,
             std::size_t place,
             std::span<char> packet) const {
    StorePixel(pixel, PlaceOfPixel(column, place), packet);
  }

 private:
  [[nodiscard]] bool has_low_rate() const {
    return profile_ != OusterProfile::kLegacy && profile_ != OusterProfile::kSingle &&
           profile_ != OusterProfile::kDual;
  }
  [[nodiscard]] std::size_t PlaceOfColumn(std::size_t column) const {
    return header_size_ + column * column_size_;
  }

  OusterProfile profile_;
  bool has_fusa_header_, has_wide_reflectivity_;
  std::size_t num_columns_, num_pixels_;
  std::size_t header_size_, column_header_size_, pixel_size_, column_size_, packet_size_;
};

/// The checksum of a packet's bytes: CRC-64 of ECMA-182, bits reversed, as in the xz format.
[[nodiscard]] std::uint64_t OusterChecksum(std::span<const char> bytes);
/// The checksum that a packet states, over all bytes before it; nothing if its firmware leaves the
/// footer blank.
/// @pre The layout's packets may have one.
[[nodiscard]] bool HasRightChecksum(std::span<const char> packet);
/// Whether the packet states a checksum, right or not.
/// @pre As above.
[[nodiscard]] bool StatesChecksum(std::span<const char> packet);
void StoreChecksum(std::span<char> packet);

/// A measurement of the sensor's motion, in the axes of the sensor.
struct OusterImu {
  std::uint64_t system_time_ns{};        ///< When it was read, by the sensor's clock.
  std::uint64_t acceleration_time_ns{};  ///< When it was measured.
  std::uint64_t rotation_time_ns{};
  std::array<float, 3> acceleration_g{};  ///< With gravity: a sensor at rest has 1 upwards.
  std::array<float, 3> rotation_degps{};

  bool operator==(const OusterImu&) const = default;
};

[[nodiscard]] OusterImu ImuOf(std::span<const char, kOusterImuPacketSize> packet);
void StoreImu(const OusterImu& imu, std::span<char, kOusterImuPacketSize> packet);

}  // namespace railcast
