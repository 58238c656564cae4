#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/scenario/json_text.h"
#include "railcast/enum_names.h"
#include "railcast/error.h"
#include "railcast/scenario.h"
#include "railcast/transform.h"

namespace railcast {

/// What a pixel of an Ouster sensor's lidar packets holds: `udp_profile_lidar` of its metadata.
enum class OusterProfile { kLegacy, kSingle, kDual, kLowRate, kLowRateDual, kFusaDual };
template <>
inline constexpr auto kEnumNames<OusterProfile> = std::to_array<EnumName<OusterProfile>>(
    {{OusterProfile::kLegacy, "LEGACY"},
     {OusterProfile::kSingle, "RNG19_RFL8_SIG16_NIR16"},
     {OusterProfile::kDual, "RNG19_RFL8_SIG16_NIR16_DUAL"},
     {OusterProfile::kLowRate, "RNG15_RFL8_NIR8"},
     {OusterProfile::kLowRateDual, "RNG15_RFL8_NIR8_DUAL"},
     {OusterProfile::kFusaDual, "FUSA_RNG15_RFL8_NIR8_DUAL"}});

/// Whether a pixel holds two returns.
[[nodiscard]] constexpr bool IsDualProfile(OusterProfile profile) {
  return profile == OusterProfile::kDual || profile == OusterProfile::kLowRateDual ||
         profile == OusterProfile::kFusaDual;
}

/// A beam of an Ouster sensor.
struct OusterBeam {
  std::uint16_t pixel{};  ///< Its place in a column of the packets, 0 the highest.
  double altitude_deg{};  ///< Up positive.
  double azimuth_deg{};   ///< Added to the rotor's azimuth, in the sense of rotation.
};

/// What a packet of an Ouster sensor looks like, and what a beam means.
///
/// The sensor's frame of reference is railcast's: x forward, away from the connector. That of the
/// lidar has its origin on the rotor's axis and x towards the connector, where frames begin. The
/// rotor turns clockwise, seen from above.
struct OusterMetadata {
  std::string product_line;                      ///< "OS-1-128"; empty if not said.
  std::optional<std::uint64_t> serial_number{};  ///< As packets repeat it; absent if not said.
  std::optional<std::uint32_t> initialization_id{};
  std::uint32_t columns_per_frame{};  ///< Columns of a whole turn.
  double rate_hz{};                   ///< Turns per second.
  std::uint32_t columns_per_packet{};
  std::uint32_t pixels_per_column{};
  /// The first and the last column that are measured; the window contains the end of the turn if
  /// the first is the greater one.
  std::array<std::uint32_t, 2> column_window{};
  OusterProfile profile = OusterProfile::kLegacy;
  bool has_fusa_header{};  ///< The packets' header is that of functional safety.
  /// LEGACY packets of firmware before 2.1, or that is not said: reflectivity has 16 bits of no
  /// known scale, and not a byte.
  bool has_wide_reflectivity{};
  /// Why packets cannot be read or made, although beams, columns and rate are known.
  std::vector<Fault> packet_faults{};
  std::vector<OusterBeam> beams;  ///< By rising pixel; pixels without a beam have none.
  /// Where the beams leave, seen from the lidar: outwards at the rotor's azimuth, and up. Measured
  /// ranges count from that far before it.
  std::array<double, 2> beam_origin_m{};
  Transform sensor_from_lidar = Transform::Identity();
  Transform sensor_from_imu = Transform::Identity();

  /// Columns from the first to the last of the window.
  [[nodiscard]] std::uint32_t num_window_columns() const;
  /// What a measured range has before the beam leaves.
  [[nodiscard]] double range_offset_m() const;
};

/// The bytes of a lidar packet.
/// @pre The metadata have no `packet_faults`, for which ParseOusterOfPackets() looks.
[[nodiscard]] std::size_t OusterPacketSize(const OusterMetadata& metadata);

/// Reads the metadata of an Ouster sensor, as the sensor or Ouster's programs write it: the flat
/// layout of firmware before 2.1, or the sections of later ones. What firmware before 1.14 does not
/// say is that of the sensors of its time.
/// Packets need not be of a kind that is known.
/// @throws InputError with a line for every fault: "/beam_intrinsics/beam_altitude_angles: rule
///   (got value)".
[[nodiscard]] OusterMetadata ParseOusterMetadata(const std::string& text);

/// As ParseOusterMetadata(), but `packet_faults` are errors, too: for packets, read or made.
[[nodiscard]] OusterMetadata ParseOusterOfPackets(const std::string& text);

/// Metadata as later firmware lays it out, whichever layout `text` has; what neither has is left
/// out.
/// @pre ParseOusterMetadata(text) succeeds.
[[nodiscard]] Json SectionsOfOusterMetadata(const std::string& text);

/// Gives a sensor the scan of the metadata and, where the product line is known, what its data
/// sheets say of range, beam and return mode. A name that the sensor has is kept.
/// @throws InputError with a line for every fault, as ParseOusterMetadata() does.
void UseOusterMetadata(const std::string& text, LidarSpec& lidar);

}  // namespace railcast
