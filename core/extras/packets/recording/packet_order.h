#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
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
  std::string detail{};  ///< Detail of the first.

  void Count(std::size_t packet, std::size_t num = 1, const std::string& why = "") {
    if (num > 0 && number == 0) {
      first = packet;
      detail = why;
    }
    number += num;
  }
};

/// Counts what is missing among packets that have times, but no numbers.
///
/// What is missing in a gap is known by its time. Where the sensor is silent turn by turn, in a
/// window, it has sent nothing. A window is known by the packets whose blocks lie on both sides of
/// it; else it is an arc of at least 20 deg in which no packet lies in 32 turns, whose edges are
/// those of most gaps there, of four or five. A sensor has at most two of these, at least 20 deg
/// apart: what is missing regularly leaves more, narrower or wandering ones.
class MissingPackets {
 public:
  /// Takes the next packet.
  /// @param last The one before it in time.
  /// @param gap_ns From that one's time to its own.
  /// @param captured_ns Likewise, of the times at which they were captured.
  /// @param number OrderedPacket::number of the next one.
  void Look(const PacketMark& last,
            const PacketMark& next,
            std::int64_t gap_ns,
            std::int64_t captured_ns,
            std::size_t number);

  [[nodiscard]] PacketTally lost() const;

 private:
  static constexpr std::size_t kNumBins = 3600;

  /// Azimuths in 0.01 deg.
  struct Arc {
    std::int64_t from{};
    std::int64_t to{};

    [[nodiscard]] std::int64_t width() const;
    [[nodiscard]] std::int64_t middle() const;
    [[nodiscard]] bool Holds(std::int64_t azimuth) const;
    /// Whether another one has no more than `most` beyond either end.
    [[nodiscard]] bool IsAllOf(const Arc& other, std::int64_t most) const;
  };
  struct Window {
    Arc arc;
    double packets{};        ///< Packets that the sensor does not send there, in a turn.
    std::int64_t slack{};    ///< By which a gap's arc may be wider if nothing is missing.
    bool is_certain = true;  ///< Else it has to be seen once more.
  };
  struct Gap {
    std::int64_t begin{};  ///< Azimuth of the first block of the packet before it.
    Arc arc;
    double turns{};    ///< From `begin` to the packet behind it.
    double packets{};  ///< Packets that are missing if there is no window.
    std::size_t number{};

    [[nodiscard]] double NumPasses(const Arc& window) const;
  };

  [[nodiscard]] double TurnNs(const PacketMark& mark) const;
  void Turn(const PacketMark& last, const PacketMark& next, std::int64_t gap_ns);
  void Cover(const PacketMark& mark);
  void EndWindows(const PacketMark& mark);
  void AddWindow(const Arc& arc, const PacketMark& mark);
  void Settle();
  [[nodiscard]] PacketTally CountLost(const std::vector<Window>& windows) const;
  [[nodiscard]] bool IsCovered(const Arc& arc) const;
  [[nodiscard]] std::vector<Arc> SilentArcs() const;
  [[nodiscard]] std::vector<Window> Windows() const;
  [[nodiscard]] std::optional<Window> WindowAt(const Arc& arc) const;

  bool has_begun_{};
  std::vector<Window> windows_;  ///< The windows that are known.
  // How often how many packets are missing between two that follow each other.
  std::map<std::int64_t, std::size_t> num_missing_;
  double turned_{};     ///< How many turns the rotor has made of late,
  double turned_ns_{};  ///< and in which time.
  PacketTally lost_;
  // Since the gaps were last settled:
  std::vector<Gap> gaps_;  ///< In which there may be a window.
  std::vector<bool> is_covered_ = std::vector<bool>(kNumBins);
  std::size_t num_turns_{};
};

/// Puts the packets of a sensor into the order in which it sent them.
///
/// A packet waits until kWindow others have come, so that those that were captured earlier than
/// what was sent before them come into their places, and that one that was captured several times
/// is one. What comes later than that is left out. A sensor whose numbers are all 0 is known by its
/// times. Where the numbers or times of all further packets are lower, as after the sensor's start
/// or where its clock was set back, they begin anew.
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

  std::deque<Held> held_;    ///< By rising order.
  std::deque<Held> behind_;  ///< As they came: all since a packet that was not behind the released.
  std::deque<Held> set_back_;  ///< As they came: the last, if the clock may have been set back.
  std::deque<OrderedPacket> ready_;
  std::deque<Released> released_;  ///< The last ones, since the numbers began.
  std::optional<std::pair<std::int64_t, PacketMark>> newest_;  ///< Order and mark.
  std::optional<std::int64_t> zero_ns_;  ///< Time of the last packet, if its number was 0.
  bool ignores_numbers_ = false;         ///< They are all 0.
  MissingPackets missing_;
  PacketTally lost_, doubled_, late_, reordered_;
};

}  // namespace railcast
