#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/extras/packets/spinning/sensor_turn.h"

namespace railcast {

/// Where a packet stands in a recording.
struct PacketPlace {
  std::uint64_t datagram{};  ///< Number of its datagram.
  std::size_t offset{};      ///< In the payload.
};

/// A packet that its sensor's decoder does not refuse.
struct OrderedPacket {
  std::vector<char> bytes;
  std::vector<PacketPlace> places;  ///< Several if it was captured several times.
  std::size_t number{};             ///< Among the captured, for messages.
  std::int64_t captured_ns{};
};

/// How many packets something is said of.
struct PacketTally {
  std::size_t number{};
  std::size_t first{};   ///< OrderedPacket::number of the first.
  std::string detail{};  ///< Of that.

  void Count(std::size_t packet, std::size_t num = 1, const std::string& why = "") {
    if (num > 0 && number == 0) {
      first = packet;
      detail = why;
    }
    number += num;
  }
};

/// Puts the packets of a sensor into the order in which it sent them.
///
/// A packet waits until kWindow others have come, so that those that were captured earlier than
/// what was sent before them come into their places, and that one that was captured several times
/// is one. What comes later than that is left out. A sensor whose numbers are all 0 is known by its
/// times. Where the numbers or times of all further
/// packets are lower, as after the sensor's start or where its clock was set back, they begin anew.
class PacketOrder {
 public:
  static constexpr std::size_t kWindow = 64;

  void Add(OrderedPacket packet, PacketMark mark);
  /// Says that there are no further packets.
  void End();
  /// Returns the next packet that is in its place; nothing if others must come first.
  [[nodiscard]] std::optional<OrderedPacket> Next();

  /// Number of the first datagram with a packet that Next() has not returned; nothing if there is
  /// none.
  [[nodiscard]] std::optional<std::uint64_t> first_held_datagram() const;

  // How many packets are missing before those that are numbered here, had come before, were left
  // out since they came too late, or came later than others that were sent after them.
  [[nodiscard]] PacketTally lost() const;
  [[nodiscard]] const PacketTally& doubled() const { return doubled_; }
  [[nodiscard]] const PacketTally& late() const { return late_; }
  [[nodiscard]] const PacketTally& reordered() const { return reordered_; }

 private:
  struct Held {
    OrderedPacket packet;
    PacketMark mark;
    std::int64_t order{};  ///< PacketMark::number, which goes on where that begins anew.
  };
  /// What is kept of a packet that was returned.
  struct Released {
    std::int64_t order{};
    std::int64_t captured_ns{};
    std::size_t hash{};
    PacketMark mark{};
  };

  /// Azimuths between which nothing was sent: packets were lost, or it is a window.
  struct Silence {
    std::int64_t from{};
    std::int64_t to{};
    std::int64_t order{};        ///< Of the packet behind it, in the last of its turns.
    std::int64_t num_turns = 1;  ///< Less those in which something was sent.
    PacketTally lost{};          ///< If it is no window.

    [[nodiscard]] bool is_window() const { return num_turns >= 3; }
    [[nodiscard]] std::int64_t middle() const;
    [[nodiscard]] bool IsNear(const Silence& other) const;
  };

  [[nodiscard]] bool JoinSame(const Held& held, std::deque<Held>& others);
  [[nodiscard]] bool IsKnown(const Held& held) const;
  [[nodiscard]] bool MayBeSetBack(const Held& held) const;
  void AddSetBack(Held held);
  void CheckNumber(PacketMark& mark);
  void Place(Held held);
  void BeginAnew();
  void ReleaseFirst();
  void ReleaseAll();
  void CountLost(const Held& next);
  void EndSilences(const Held& next);
  void AddSilence(Silence silence);
  /// How long the windows within a gap last.
  [[nodiscard]] std::int64_t SilentNs(const PacketMark& last,
                                      std::int64_t gap_ns,
                                      const Silence& within) const;

  std::deque<Held> held_;    ///< By rising order.
  std::deque<Held> behind_;  ///< As they came: all since a packet that was not behind the released.
  std::deque<Held> set_back_;  ///< As they came: the last, if the clock may have been set back.
  std::deque<OrderedPacket> ready_;
  std::deque<Released> released_;  ///< The last ones, since the numbers began.
  std::optional<std::pair<std::int64_t, PacketMark>> newest_;  ///< Order and mark.
  std::optional<std::int64_t> zero_ns_;  ///< Time of the last packet, if its number was 0.
  bool ignores_numbers_ = false;         ///< They are all 0.
  std::vector<Silence> silences_;
  PacketTally lost_, doubled_, late_, reordered_;
};

}  // namespace railcast
