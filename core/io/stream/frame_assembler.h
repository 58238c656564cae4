#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/io/stream/received_frame.h"
#include "core/io/stream/stream_datagram.h"

namespace railcast {

/// What a receiver has seen. Packets are datagrams of the protocol.
struct StreamCounts {
  std::uint64_t complete_frames{};
  std::uint64_t incomplete_frames{};  ///< Given with some of their packets lost.
  std::uint64_t missing_frames{};     ///< Never seen, between others that were.
  std::uint64_t received_packets{};   ///< Sound ones; the three lines below included.
  std::uint64_t duplicate_packets{};
  std::uint64_t late_packets{};       ///< Of frames that had been given without them.
  std::uint64_t reordered_packets{};  ///< Behind one that was sent after them, and still in time.
  std::uint64_t lost_packets{};       ///< Of incomplete frames; those of missing ones are unknown.
  std::uint64_t stray_packets{};  ///< Sound ones of another run or sensor, or of a frame long past.
  std::uint64_t restarts{};       ///< Frame numbers began anew.
  std::array<std::uint64_t, kStreamFaultNames.size()> refused{};  ///< By StreamFault.
  /// Who else was heard last: another sensor than the one whose frames are given.
  std::optional<std::uint16_t> other_sensor{};

  [[nodiscard]] std::uint64_t num_refused() const;
};

/// Puts a stream's frames together again, whatever happened to its datagrams: lost, doubled,
/// reordered, damaged, made up.
///
/// Frames come in the order of their numbers. A frame is given as soon as it is complete; or
/// incomplete, as soon as a later one is complete or two later ones have begun. So at most two
/// frames are open, and memory is in proportion to what arrived, whatever it claims.
///
/// A larger run number begins anew at once. Sixteen datagrams in a row that make no sense otherwise
/// (a smaller run, another sensor, frames more than eight behind) begin anew, too: a sender that
/// was restarted, or somebody's joke that is over. Datagrams carry no signature: who can send to
/// the port can disturb. Two senders at once disturb each other, unless they are different sensors
/// and the assembler is bound to one: then it never begins anew with another.
class FrameAssembler {
 public:
  /// @param sensor Whose datagrams are taken; all others are strays. Nothing: whoever comes first.
  explicit FrameAssembler(std::optional<std::uint16_t> sensor = std::nullopt)
      : only_sensor_(sensor) {}

  /// Appends the frames that this datagram completes or gives up to `frames`.
  void Take(std::span<const char> datagram, std::vector<ReceivedFrame>& frames);
  /// Gives up the open frames: nothing more will come.
  void Flush(std::vector<ReceivedFrame>& frames);

  [[nodiscard]] const StreamCounts& counts() const { return counts_; }

 private:
  struct Arrival {
    std::uint32_t packet{};
    std::size_t offset{};  ///< In OpenFrame::points.
    std::size_t size{};
  };
  struct OpenFrame {
    std::vector<char> header;
    std::uint16_t points_each{};
    std::vector<bool> has_packet;
    std::vector<Arrival> arrivals;
    std::vector<char> points;  ///< In the order of arrival.
  };
  struct GivenFrame {
    std::uint32_t number{};
    std::vector<bool> had_packet;
  };
  enum class Place : std::uint8_t { kHere, kPast, kElsewhere };

  [[nodiscard]] Place PlaceOf(const StreamDatagram& datagram) const;
  [[nodiscard]] bool BeginsAnew(const StreamDatagram& datagram);
  void CountPast(const StreamDatagram& datagram);
  void Store(const StreamDatagram& datagram, std::vector<ReceivedFrame>& frames);
  void GiveFirst(std::vector<ReceivedFrame>& frames);
  static ReceivedFrame Assemble(OpenFrame& open);

  std::optional<std::uint16_t> only_sensor_;
  StreamCounts counts_;
  bool has_run_ = false;
  std::uint32_t run_{};
  std::uint16_t sensor_{};
  std::uint32_t num_strays_{};  ///< In a row.
  std::map<std::uint32_t, OpenFrame> open_;
  std::deque<GivenFrame> given_;                      ///< The last ones.
  std::pair<std::uint32_t, std::uint16_t> furthest_;  ///< Frame and packet.
};

}  // namespace railcast
