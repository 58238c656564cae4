#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "core/extras/packets/recording/packet_order.h"
#include "core/extras/packets/recording/turn_reader.h"
#include "generator/extras/insert/inserted_frame.h"

namespace railcast {

/// A packet after its firings were edited.
struct EditedPacket {
  std::uint64_t datagram{};  ///< Number of its datagram among those taken, from 0.
  std::size_t offset{};      ///< In the payload.
  std::vector<char> before;
  std::vector<char> after;
};

/// Puts the edits of frames into the packets that they were read from.
class TurnEditor {
 public:
  /// @param source Names the recording in messages.
  TurnEditor(const CaptureSensor& sensor, const std::string& source);

  /// Takes the next datagram of the recording.
  /// @throws InputError as TurnReader does.
  void Take(const CapturedDatagram& datagram);
  /// Says that there are no further datagrams.
  void End();

  /// Whether all packets of this turn were taken.
  /// @param turn Counted as the frames of the recording.
  [[nodiscard]] bool Has(std::uint32_t turn) const { return turn < first_turn_ + turns_.size(); }
  /// Lets go of turns before this one.
  void Skip(std::uint32_t turn);
  /// Edits the packets of a turn, and lets go of those before it.
  /// @param inserted Its frame.index is the turn's.
  /// @pre Has(turn); turns rise.
  /// @throws InputError "capture: turn 3: rule (got value)" if a packet cannot state an edit.
  [[nodiscard]] std::vector<EditedPacket> Edit(const InsertedFrame& inserted);

  /// Number of the first datagram that may still be edited.
  [[nodiscard]] std::uint64_t first_open_datagram() const;

 private:
  struct HeldPacket {
    OrderedPacket packet;
    std::optional<std::vector<char>> before{};  ///< If it was edited.
  };

  void Hold(std::deque<OrderedPacket> decoded);

  void EditFiring(const FiringPlace& place, const EditedReturns& returns);
  [[nodiscard]] std::vector<EditedPacket> TakeEdited(const SensorTurn& turn);

  TurnReader reader_;
  std::string source_;
  std::deque<SensorTurn> turns_;  ///< Not edited yet.
  std::uint32_t first_turn_{};    ///< Number of their first.
  std::deque<HeldPacket> packets_;
  std::uint32_t first_packet_{};  ///< Number of their first, as FiringPlace counts them.
};

}  // namespace railcast
