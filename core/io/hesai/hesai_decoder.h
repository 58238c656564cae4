#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/io/hesai/hesai_model.h"
#include "core/io/sensor_turn.h"
#include "core/io/turn_edit.h"

namespace railcast {

/// Turns the data packets of a Hesai sensor into points.
///
/// A laser's azimuth is that of its block, plus the laser's own offset, plus the rotation of the
/// rotor until the laser fires (at the speed that the packet states), unless the sensor has already
/// accounted for that. A cycle that lacks a loop is left out. A turn ends where the azimuth falls.
/// A packet one of whose checksums is wrong is refused. Raw distances that say why there is no
/// point, as those of 128E4X below 4 do, give none. The stamp of a turn counts from 1970-01-01 by
/// the sensor's own clock, or from the start of the day if that clock has no date.
class HesaiDecoder {
 public:
  /// @param model Must outlive the decoder.
  explicit HesaiDecoder(const HesaiModel& model);

  /// Takes the payload of a data packet and appends the turns that it completes.
  /// @returns Why the payload was refused, as "rule (got value)", if it was; nothing of a refused
  ///   payload is used.
  [[nodiscard]] std::optional<std::string> Decode(std::span<const char> payload,
                                                  std::vector<SensorTurn>& turns);

  /// Returns the turn that no packet has completed yet, and starts a new one.
  [[nodiscard]] SensorTurn TakeUnfinished();

  /// Stores the returns of a firing in its packet.
  /// @pre The decoder has taken the packet.
  /// @returns Why the packet cannot state them; it is then unchanged.
  [[nodiscard]] std::optional<std::string> Store(const EditedReturns& returns,
                                                 const FiringPlace& place,
                                                 std::span<char> packet) const;
  /// Brings a packet's checksums up to what was stored in it.
  void Seal(std::span<char> packet) const;

 private:
  struct Channel {
    double sine{};  ///< Sine of the elevation.
    double cosine{};
    double azimuth_deg{};
    double turned_us{};      ///< Time of the firing since the rotor was at the block's azimuth.
    std::int64_t time_ns{};  ///< Time of the firing since the start of the cycle.
    std::uint16_t ring{};
    std::uint8_t laser{};
  };
  /// The blocks of one loop.
  struct Group {
    std::vector<char> blocks;
    std::uint32_t packet{};  ///< Its number, as FiringPlace counts them.
    std::uint32_t place{};   ///< Of the blocks in it.
    std::size_t loop{};
    std::int64_t time_ns{};   ///< When the loop begins.
    std::uint16_t azimuth{};  ///< In 0.01 deg.
    double unit_m{};
    double speed_deg_per_us{};
    bool is_dual{};
    bool has_last_second{};  ///< Whether the second block holds the last return.
  };

  [[nodiscard]] Group GroupOf(std::span<const char> payload, std::size_t block) const;
  void Take(Group group, std::vector<SensorTurn>& turns);
  void AddCycle(std::vector<SensorTurn>& turns);
  void AddGroup(const Group& group);
  void AddPoint(const char* place, const Group& group, const Channel& channel, TurnPoint point);

  const HesaiModel* model_;
  std::vector<std::vector<Channel>> loops_;
  std::uint32_t num_packets_{};
  std::vector<Group> cycle_;  ///< The loops of a cycle that is not complete.
  std::optional<std::uint16_t> last_azimuth_;
  SensorTurn turn_;
};

}  // namespace railcast
