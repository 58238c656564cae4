#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/extras/packets/ouster/ouster_packet.h"
#include "core/extras/packets/spinning/sensor_turn.h"
#include "core/extras/packets/spinning/turn_edit.h"
#include "core/scenario/ouster_metadata.h"
#include "railcast/lidar.h"
#include "railcast/transform.h"

namespace railcast {

/// The lasers of a sensor, as those of others, in the order of its beams.
[[nodiscard]] std::vector<ChannelSpec> ChannelsOf(const OusterMetadata& metadata);

/// Turns the lidar packets of an Ouster sensor into points in the sensor's axes.
///
/// A turn is what has one frame number, in the order of its columns; columns that were not measured
/// or did not arrive are left out. Ranges count from where the beams leave. A packet that comes
/// after its frame has ended is left out. The stamp of a turn is the time of its first column by
/// the sensor's clock. Each point has the fields `signal` and `near_ir`, in photons, as far as the
/// profile has them.
class OusterDecoder {
 public:
  explicit OusterDecoder(const OusterMetadata& metadata);

  /// Why a payload is no lidar packet of the sensor, as "rule (got value)", if it is none.
  [[nodiscard]] std::optional<std::string> Refuse(std::span<const char> payload) const;
  /// Takes the payload of a lidar packet and appends the turns that it completes.
  /// @pre Refuse() does not.
  void TakePacket(std::span<const char> payload, std::vector<SensorTurn>& turns);
  /// @pre As above.
  [[nodiscard]] PacketMark MarkOf(std::span<const char> payload) const;

  /// Returns the turn that no packet has completed yet, and starts a new one.
  [[nodiscard]] SensorTurn TakeUnfinished();

  /// Stores the returns of a firing in its packet.
  /// @pre The decoder has taken the packet.
  /// @returns Why the packet cannot state them; it is then unchanged.
  [[nodiscard]] std::optional<std::string> Store(const EditedReturns& returns,
                                                 const FiringPlace& place,
                                                 std::span<char> packet) const;
  /// Brings a packet's checksum, if it has one, up to what was stored in it.
  void Seal(std::span<char> packet) const;

  [[nodiscard]] const OusterLayout& layout() const { return layout_; }

 private:
  struct Beam {
    std::uint16_t pixel{};
    std::uint16_t ring{};
    double sine{};  ///< Sine of the altitude.
    double cosine{};
    double azimuth_rad{};  ///< Clockwise.
  };
  /// A column of the unfinished turn: its place among the points.
  struct Column {
    std::uint16_t measurement_id{};
    std::int64_t time_ns{};
    std::size_t first_point{};
    std::size_t num_points{};
    std::size_t first_place{};  ///< Its place among the places.
  };

  [[nodiscard]] std::optional<std::string> RefuseColumns(std::span<const char> payload) const;
  [[nodiscard]] std::optional<std::string> StoreReturn(const EditedReturn& edited,
                                                       const OusterPixel& recorded,
                                                       OusterReturn& stored) const;
  void AddColumn(std::span<const char> payload, std::size_t place);
  void AddPoint(const OusterReturn& measured, const Beam& beam, double rotor_rad, TurnPoint point);

  OusterMetadata metadata_;
  OusterLayout layout_;
  std::vector<Beam> beams_;
  std::optional<std::uint32_t> frame_id_;
  std::vector<Column> columns_;
  std::vector<bool> is_seen_;  ///< By measurement.
  std::vector<TurnPoint> points_;
  std::vector<float> signals_, near_irs_;  ///< By point.
  std::vector<FiringPlace> places_;        ///< By column, as they came, then by ring.
  std::uint32_t num_packets_{};
  /// Packets of a turn that begin before each column, of those with columns of the window; last,
  /// their number in a turn.
  std::vector<std::int64_t> packets_before_;
};

}  // namespace railcast
