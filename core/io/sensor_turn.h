#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace railcast {

/// A return in a packet of a spinning sensor.
struct TurnPoint {
  float x{}, y{}, z{};  ///< m, our sensor axes: x forward, y left, z up.
  float range_m{};
  float azimuth_rad{};     ///< Clockwise from forward, 0 to 2 pi.
  std::int64_t time_ns{};  ///< Since the turn's stamp.
  std::uint32_t column{};  ///< Firing cycle of the turn, from 0.
  std::uint16_t ring{};    ///< Row by rising elevation, 0 the lowest.
  std::uint8_t laser{};    ///< The vendor's number, from 0.
  std::uint8_t intensity{};
  /// 0, or in dual mode 0 for the last return and 1 for the other, which is left out where it
  /// repeats the last.
  std::uint8_t return_index{};
};

/// What one turn of the rotor saw, in order of time.
struct SensorTurn {
  /// Of its first firing cycle; since when, its decoder says.
  std::int64_t stamp_ns{};
  std::vector<TurnPoint> points;
  /// When each firing cycle of the packets began, since the stamp: a laser of it without a point is
  /// one whose distance was 0. Cycles of packets that are missing are missing here, too.
  std::vector<std::int64_t> column_time_ns;
  bool is_dual{};  ///< Whether any of its packets was of dual mode.

  [[nodiscard]] std::size_t num_columns() const { return column_time_ns.size(); }
};

}  // namespace railcast
