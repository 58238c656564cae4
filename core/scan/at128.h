#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "railcast/lidar.h"

namespace railcast {

inline constexpr std::size_t kAt128Lasers = 128;

/// The angles of one AT128: its correction file, which the sensor holds and its maker's tools save
/// as a .dat file. Three mirrors in turn sweep the view, each for a part of the rotor's turn, its
/// field.
class At128Correction {
 public:
  /// Reads the bytes of a correction file of version 5.
  /// @throws InputError "rule (got value)" if they are none.
  explicit At128Correction(std::span<const char> bytes);

  static constexpr std::uint32_t kFields = 3;
  static constexpr double kFieldTurn_deg = 120.0;
  static constexpr double kStepsPerDeg = 25'600.0;  ///< Steps of azimuths in files and packets.

  /// The direction of a laser. Azimuths count clockwise from forward.
  struct Direction {
    double azimuth_deg{};
    double elevation_deg{};
  };

  /// The field, 0 to 2, in which the rotor is at this azimuth of a block.
  [[nodiscard]] std::size_t FieldAt(double block_deg) const;
  /// @param field That of the block.
  [[nodiscard]] Direction At(double block_deg, std::size_t field, std::size_t laser) const;
  /// The elevation of a laser, before the shifts that depend on the rotor's azimuth.
  [[nodiscard]] double elevation_deg(std::size_t laser) const { return elevation_deg_[laser]; }

  /// The mean azimuth of the rotor at which fields start, beyond the first, second and third 120
  /// deg.
  [[nodiscard]] double mean_start_deg() const { return mean_start_deg_; }

 private:
  void CheckStarts();
  static constexpr std::size_t kShifts = 180;  ///< One for every 2 deg of the rotor.
  using Shifts = std::vector<std::int8_t>;     ///< By laser, then by the rotor's azimuth.

  /// Rounded to 0.01 deg, as the maker's decoder does.
  [[nodiscard]] double Shift_deg(const Shifts& shifts, double block_deg, std::size_t laser) const;

  double resolution_{};  ///< The unit of shifts in 0.01 deg.
  std::array<double, kFields> start_deg_{};
  double mean_start_deg_{};
  std::array<double, kAt128Lasers> azimuth_deg_{};
  std::array<double, kAt128Lasers> elevation_deg_{};
  Shifts azimuth_shifts_;
  Shifts elevation_shifts_;
};

/// Whether a file begins as correction files do.
/// @throws InputError if it cannot be read.
[[nodiscard]] bool IsAt128File(const std::filesystem::path& file);

/// Reads a correction file, whose last 32 bytes are the SHA-256 of those before.
/// @throws InputError "file: rule (got value)"; also if it is damaged.
[[nodiscard]] At128Correction ReadAt128Correction(const std::filesystem::path& file);

/// From one block, in which each laser fires once, to the next.
inline constexpr double kAt128Block_us = 41.666;

/// When each laser fires, in ns since its block began (tier4/nebula, pandar_at128.hpp).
inline constexpr std::array<std::uint16_t, kAt128Lasers> kAt128Firing_ns = {
    0,     0,     8240,  4112,  4144,  8240,  0,     0,     12424, 4144,  4112,  8264,  12376,
    12376, 8264,  12424, 0,     0,     4112,  8240,  4144,  0,     0,     4144,  12424, 8264,
    4112,  12376, 12376, 12424, 8264,  848,   2504,  4976,  6616,  6616,  9112,  2504,  848,
    10768, 13280, 13280, 4976,  9112,  14928, 14928, 10768, 2504,  848,   6616,  4976,  9112,
    6616,  848,   2504,  13280, 10768, 4976,  13280, 14928, 9112,  10768, 14928, 13280, 848,
    9112,  13280, 2504,  4976,  848,   2504,  14928, 10768, 10768, 14928, 4976,  6616,  6616,
    9112,  848,   13280, 13280, 9112,  4976,  2504,  2504,  848,   10768, 14928, 14928, 10768,
    6616,  4976,  9112,  6616,  4112,  12424, 0,     4144,  0,     0,     12424, 0,     8264,
    4112,  4144,  8240,  8240,  8264,  12376, 12376, 12424, 4112,  4144,  0,     0,     0,
    0,     0,     12424, 8264,  8240,  4144,  8264,  8240,  12376, 12376, 8264};

/// The lasers: their elevations without shifts, and when they fire.
[[nodiscard]] std::vector<ChannelSpec> At128Channels(const At128Correction& correction);

/// How many blocks sweep the view of 120 deg, which a mirror does while the rotor turns by 60 deg:
/// 1200 at 10 Hz. The number is even, so that no packet of two blocks is of two mirrors.
/// @param rate_hz Of frames, of which each is a mirror's sweep; the rotor turns once in three.
[[nodiscard]] std::uint32_t At128Columns(double rate_hz);

/// Where the rotor is when a block begins, in 1/256 of 0.01 deg, as packets say it. The sweeps lie
/// about forward, on the mean of the mirrors: starts of fields are not quite 120 deg apart.
[[nodiscard]] std::uint32_t At128Azimuth(const At128Correction& correction,
                                         double rate_hz,
                                         std::uint32_t frame,
                                         std::uint32_t column);

}  // namespace railcast
