#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/extras/packets/spinning/sensor_turn.h"
#include "core/extras/packets/spinning/spinning_model.h"
#include "core/extras/packets/spinning/turn_edit.h"

namespace railcast {

/// Turns the data packets of a spinning sensor, real or simulated, into points.
///
/// A laser's azimuth is that of its block, plus the laser's own offset, plus the rotation of the
/// rotor until the laser fires, unless the sensor has already accounted for that: at the speed that
/// the packet states, or else at the median speed over the packet. A cycle that lacks a loop is
/// left out. A turn ends where the azimuth falls, or the next mirror begins. Raw distances that say
/// why there is no point give none. A packet one of whose checksums is wrong is refused.
///
/// The stamp of a turn counts from 1970-01-01 by the sensor's own clock, or from the start of the
/// day if that clock has no date. Where packets have no date, it counts from the start of the hour
/// in which the first packet was sent; after 10,000 hours that count starts anew. Within such a
/// packet, the blocks after the gap of an azimuth window are timed by how far the rotor has turned,
/// to within a firing cycle.
class SpinningDecoder {
 public:
  explicit SpinningDecoder(SpinningModel model);

  /// Why a payload is no data packet of the sensor, as "rule (got value)", if it is none.
  [[nodiscard]] std::optional<std::string> Refuse(std::span<const char> payload) const;
  /// Takes the payload of a data packet and appends the turns that it completes.
  /// @pre Refuse() does not.
  void TakePacket(std::span<const char> payload, std::vector<SensorTurn>& turns);
  /// @pre As above.
  [[nodiscard]] PacketMark MarkOf(std::span<const char> payload) const;
  /// Blocks of zeros, which are left out.
  /// @pre As above.
  [[nodiscard]] std::size_t NumEmptyBlocks(std::span<const char> payload) const;
  /// Number of the packets so far that have a loop of a cycle that lacks another one.
  [[nodiscard]] std::size_t num_incomplete() const { return num_incomplete_; }

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

  [[nodiscard]] const SpinningModel& model() const { return model_; }

 private:
  struct Channel {
    double sine{};  ///< Sine of the elevation.
    double cosine{};
    double azimuth_deg{};
    double turned_us{};      ///< Time of the firing since the rotor was at the block's azimuth.
    std::int64_t time_ns{};  ///< Time of the firing since the start of the cycle.
    std::uint32_t cycle{};   ///< Firing cycle of the block.
    std::uint32_t place{};   ///< Place of its return in the blocks.
    std::uint16_t ring{};
    std::uint8_t laser{};
  };
  /// The blocks of one loop, or of the cycles in a block.
  struct Group {
    std::vector<char> blocks;
    std::uint32_t packet{};  ///< Its number, as FiringPlace counts them.
    std::uint32_t place{};   ///< Place of the blocks in it.
    std::size_t loop{};
    std::int64_t time_ns{};   ///< When the loop begins.
    std::uint16_t azimuth{};  ///< In 0.01 deg.
    double azimuth_deg{};
    double unit_m{};
    double speed_deg_per_us{};
    bool is_dual{};
    bool has_last_second{};  ///< Whether the second block holds the last return.
  };
  /// A group of which a packet states the time: its first.
  struct StatedGroup {
    std::uint16_t azimuth{};
    std::int64_t time_ns{};
  };

  [[nodiscard]] std::int64_t PacketNs(std::uint32_t us_past_hour);
  /// How many groups the rotor needs to turn from the last one to this azimuth: one, or more where
  /// a sensor that fires in a window of azimuths has not fired.
  /// @param usual_step Between groups, in 0.01 deg.
  [[nodiscard]] std::int64_t GroupsTo(std::uint16_t azimuth,
                                      std::int64_t usual_step,
                                      double group_ns) const;
  void TakeDated(std::span<const char> payload, std::vector<SensorTurn>& turns);
  void TakeUndated(std::span<const char> payload, std::vector<SensorTurn>& turns);
  /// Takes the group that begins with a block.
  void Take(std::span<const char> payload,
            std::size_t block,
            std::int64_t time_ns,
            double speed_deg_per_us,
            std::vector<SensorTurn>& turns);
  /// Counts a packet one of whose loops is left out.
  void LeaveOut(std::uint32_t packet);
  /// Whether a group is of another turn than that so far.
  [[nodiscard]] bool BeginsTurn(const Group& first);
  void AddCycle(std::vector<SensorTurn>& turns);
  void AddGroup(const Group& group);
  void AddPoint(const char* place, const Group& group, const Channel& channel, TurnPoint point);

  SpinningModel model_;
  std::vector<std::vector<Channel>> loops_;
  std::uint32_t num_packets_{};
  std::vector<Group> cycle_;  ///< One for each loop.
  std::size_t num_loops_{};   ///< Loops that an incomplete cycle has.
  std::size_t num_incomplete_{};
  std::optional<std::uint32_t> last_incomplete_;  ///< The last one of these packets.
  std::optional<std::int64_t> last_packet_us_;    ///< Continues counting across hours.
  std::optional<std::uint16_t> last_azimuth_;
  std::size_t field_{};                ///< The mirror's field in the last group.
  std::optional<StatedGroup> stated_;  ///< The first one of the turn.
  std::int64_t last_group_ns_{};
  SensorTurn turn_;
};

}  // namespace railcast
