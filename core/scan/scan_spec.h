#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace railcast {

/// A rectangular grid of directions, as the published system scans.
///
/// Beams go through the centres of the cells: 60 x 30 deg at 0.25 deg is 240 x 120 cells, the
/// published 28,800 beams. Columns fire in time from the first (left) to the last, spread evenly
/// over 1 / rate_hz; all rows of a column fire together.
struct RasterSpec {
  double horizontal_fov_deg{};      ///< > 0, <= 360.
  double vertical_fov_deg{};        ///< > 0, <= 180, symmetric about the horizon.
  double angular_resolution_deg{};  ///< > 0; must divide both fields of view to 1e-6 of a cell.
  std::string order = "columns";    ///< What advances in time: "columns" or "rows".

  bool operator==(const RasterSpec&) const = default;
};

/// One laser of a spinning sensor.
struct ChannelSpec {
  double elevation_deg{};  ///< Up positive.
  double azimuth_deg{};    ///< Added to the rotor's azimuth; same sense as the rotation.
  double time_us{};        ///< Since the start of the firing cycle; the earliest is 0.

  bool operator==(const ChannelSpec&) const = default;
};

/// A spinning sensor: channels that fire once a cycle while the rotor turns.
///
/// All its azimuths count in the sense of its rotation, as vendors' do: those of a clockwise sensor
/// grow to the right. A firing at t looks at start_azimuth_deg + 360 rate_hz t + the channel's
/// azimuth_deg. Rows are the channels by rising elevation.
/// Columns are firing cycles. A frame takes a fixed number of them and its stamps are exactly
/// 1 / rate_hz apart: columns x cycle_us may be less than that, not more.
struct SpinningSpec {
  std::vector<ChannelSpec> channels;   ///< In the vendor's laser order.
  double cycle_us{};                   ///< From one firing cycle to the next.
  std::uint32_t columns{};             ///< Firing cycles a frame.
  std::string rotation = "clockwise";  ///< Seen from above: "clockwise" or "counterclockwise".
  double start_azimuth_deg{};          ///< Of the rotor at the stamp; 0 = forward (+x).

  bool operator==(const SpinningSpec&) const = default;
};

/// Any order of firings, from a CSV file with the header `azimuth_deg,elevation_deg,time_us`:
/// azimuth left (counterclockwise) positive, time from 0 and non-decreasing. The frame has one row,
/// a column for each firing.
struct FiringTableSpec {
  std::string file;  ///< Relative to the file that names it.

  bool operator==(const FiringTableSpec&) const = default;
};

struct ScanSpec {
  double rate_hz{};  ///< Frames per second, > 0.
  std::variant<RasterSpec, SpinningSpec, FiringTableSpec> pattern;

  bool operator==(const ScanSpec&) const = default;
};

}  // namespace railcast
