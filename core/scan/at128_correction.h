#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

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
  static constexpr double kStepsPerDeg = 25'600.0;  ///< Of azimuths in files and packets.

  /// The direction of a laser. Azimuths count clockwise from forward.
  struct Direction {
    double azimuth_deg{};
    double elevation_deg{};
  };

  /// The field, 0 to 2, in which the rotor is at this azimuth of a block.
  [[nodiscard]] std::size_t FieldAt(double block_deg) const;
  /// @param field That of the block.
  [[nodiscard]] Direction At(double block_deg, std::size_t field, std::size_t laser) const;
  /// Of a laser, before the shifts that depend on the rotor's azimuth.
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

/// Reads a correction file.
/// @throws InputError "file: rule (got value)".
[[nodiscard]] At128Correction ReadAt128Correction(const std::filesystem::path& file);

}  // namespace railcast
