#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace railcast {

/// A return in a packet of a spinning sensor.
struct TurnPoint {
  float x{}, y{}, z{};  ///< In m, in railcast's sensor axes: x forward, y left, z up.
  float range_m{};
  float azimuth_rad{};        ///< Clockwise from forward, 0 to 2 pi.
  std::int64_t time_ns{};     ///< Time since the turn's stamp.
  std::uint32_t column{};     ///< Index of the firing cycle in the turn, from 0.
  std::uint16_t ring{};       ///< Row by rising elevation, 0 the lowest.
  std::uint8_t laser{};       ///< The vendor's number of the laser, from 0.
  std::uint16_t intensity{};  ///< As IntensityBytes says.
  /// 0; in dual mode 0 for the last return and 1 for the other one, which is left out where it
  /// repeats the last.
  std::uint8_t return_index{};
};

/// The most firing cycles of a turn; a longer turn is cut, so that a rotor that stands still cannot
/// fill the memory even where it sees nothing. Real turns have at most 4340 cycles (HDL-32E at 5
/// Hz).
inline constexpr std::size_t kMaxTurnColumns = std::size_t{1} << 14U;

/// Why decoders refuse a packet one of whose checksums is wrong: it was damaged on its way.
inline constexpr std::string_view kWrongChecksum = "the checksum must be that of its bytes";

/// What a packet says of its place among those of its sensor.
struct PacketMark {
  /// Counted by the sensor, else a time in ns.
  std::int64_t number{};
  bool has_number = true;  ///< Else the packet follows the one that came before.
  bool is_counted{};
  std::int64_t period{};  ///< After which numbers begin anew; 0 = never.
  /// The time that it states, since whenever; two of one number and time are one.
  std::int64_t time_ns{};
  std::int64_t time_period_ns{};  ///< As `period`, of the time.
  // Where packets are known by their times:
  std::int64_t packet_ns{};  ///< From it to the next one.
  // Azimuths are in 0.01 deg, of its first and last block.
  std::int64_t first_azimuth{};
  std::int64_t last_azimuth{};
  std::int64_t azimuth_step{};  ///< From block to block.
  std::int64_t turn_ns{};       ///< At which the blocks turn; 0 if they stand still.
  // The azimuths of the blocks between which the sensor seems to be silent; the same if it is not.
  std::int64_t silent_from{};
  std::int64_t silent_to{};
};

/// What a sensor measures of each point besides its place and intensity.
struct TurnField {
  std::string name;           ///< As in RecordedFrame::foreign.
  std::vector<float> values;  ///< One for each point of the turn.
};

/// Where the rotor was as a firing cycle, or one of its loops, began, as its packet says.
struct TurnAim {
  double azimuth_deg{};       ///< Clockwise from forward.
  double speed_deg_per_us{};  ///< 0 where the packet's angles have accounted for it.
};

/// Where in its packet a firing's returns stand.
struct FiringPlace {
  std::uint32_t packet{};  ///< Number among all packets that the decoder was given, from 0.
  std::uint32_t first{};   ///< Byte at which the return of index 0 begins.
  std::uint32_t second{};  ///< Byte of index 1, where that has a place of its own; else 0.
};

/// The points of one turn of the rotor in order of time.
struct SensorTurn {
  /// Time of the first firing cycle; each decoder defines its epoch.
  std::int64_t stamp_ns{};
  std::vector<TurnPoint> points;
  std::vector<TurnField> fields{};
  /// When each firing cycle in the packets began, since the stamp. A laser of such a cycle without
  /// a point had distance 0. Cycles of missing packets are missing here, too.
  std::vector<std::int64_t> column_time_ns;
  /// For each of these cycles, the aim of each of its loops.
  std::vector<TurnAim> aims;
  bool is_dual{};  ///< Whether any of its packets was in dual mode.
  /// For each laser in each firing cycle: column * rows + ring.
  std::vector<FiringPlace> places;
  /// Index of the datagram that begins the next turn, among those that a TurnReader was given.
  std::uint64_t end_datagram{};

  [[nodiscard]] std::size_t num_columns() const { return column_time_ns.size(); }
};

}  // namespace railcast
