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

#include "core/io/net/endpoint.h"
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
  std::uint64_t other_sender_packets{};  ///< Of others than the sender that is followed.
  std::uint64_t restarts{};              ///< Frame numbers began anew.
  std::array<std::uint64_t, kStreamFaultNames.size()> refused{};  ///< By StreamFault.
  /// Who else was heard last: another sensor than the one whose frames are given.
  std::optional<std::uint16_t> other_sensor{};
  std::optional<Endpoint> other_sender{};  ///< Of the last of `other_sender_packets`.

  [[nodiscard]] std::uint64_t num_refused() const;
};

/// Whose frames are wanted of all that come to a port.
struct WantedStream {
  std::optional<std::uint16_t> sensor{};  ///< Of the vehicle; nothing: whichever comes first.
  std::optional<Endpoint> from{};         ///< Whom it covers; nothing: whoever comes first.
};

/// Who sent a datagram, and when it came.
struct DatagramOrigin {
  Endpoint from{};
  std::int64_t time_ns{};  ///< Of a clock that never goes back.
};

/// Puts a stream's frames together again, whatever happened to its datagrams: lost, doubled,
/// reordered, damaged, made up.
///
/// Frames come in the order of their numbers. A frame is given as soon as it is complete; or
/// incomplete, as soon as a later one is complete or two later ones have begun. So at most two
/// frames are open, and memory is in proportion to what arrived, whatever it claims.
///
/// One sender is followed: the first of a sound datagram that is wanted. Whatever others send does
/// nothing until the one has been silent for kHold_ns; then the next one takes its place, and
/// frames begin anew. Datagrams carry no signature: who can forge the sender's address and port, or
/// is there before it, can still disturb.
///
/// Of the one sender, a larger run number begins anew at once. Sixteen of its datagrams in a row
/// that make no sense otherwise (a smaller run, another sensor, frames more than eight behind)
/// begin anew, too. If a sensor is wanted, it never begins anew with another.
class FrameAssembler {
 public:
  /// Longer than any sender pauses between two frames; shorter than it takes a user to lose
  /// patience with a sender that was started again, which has another port.
  static constexpr std::int64_t kHold_ns = 3'000'000'000;

  explicit FrameAssembler(const WantedStream& wanted = {}) : wanted_(wanted) {}

  /// Appends the frames that this datagram completes or gives up to `frames`.
  void Take(std::span<const char> datagram,
            std::vector<ReceivedFrame>& frames,
            const DatagramOrigin& origin = {});
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

  [[nodiscard]] bool IsOfAnother(const DatagramOrigin& origin) const;
  [[nodiscard]] bool IsOtherSensor(const StreamDatagram& datagram) const;
  [[nodiscard]] Place PlaceOf(const StreamDatagram& datagram) const;
  [[nodiscard]] bool BeginsAnew(const StreamDatagram& datagram);
  void CountPast(const StreamDatagram& datagram);
  void Store(const StreamDatagram& datagram, std::vector<ReceivedFrame>& frames);
  void GiveFirst(std::vector<ReceivedFrame>& frames);
  static ReceivedFrame Assemble(OpenFrame& open);

  WantedStream wanted_;
  StreamCounts counts_;
  std::optional<Endpoint> sender_;  ///< That is followed.
  std::int64_t heard_ns_{};         ///< When it was heard last.
  bool has_run_ = false;
  std::uint32_t run_{};
  std::uint16_t sensor_{};
  std::uint32_t num_strays_{};  ///< In a row.
  std::map<std::uint32_t, OpenFrame> open_;
  std::deque<GivenFrame> given_;                      ///< The last ones.
  std::pair<std::uint32_t, std::uint16_t> furthest_;  ///< Frame and packet.
};

}  // namespace railcast
