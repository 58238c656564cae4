#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/io/stream/arrivals.h"
#include "core/io/stream/stream_datagram.h"
#include "railcast/io/stream.h"

namespace railcast {

/// Reassembles the frames of a stream from datagrams that may be lost, duplicated, reordered,
/// damaged or forged.
///
/// Frames are given in the order of their numbers. A frame is given as soon as it is complete; an
/// incomplete one is given up as soon as a later frame is complete or two later ones have begun. So
/// at most two frames are open, and memory is in proportion to what arrived, whatever a datagram
/// claims.
///
/// One sender is followed: the first that sends a sound datagram of the wanted stream. Datagrams of
/// other senders have no effect until the followed one has been silent for
/// FollowedSender::kHold_ns; then the next sender takes its place, and frames begin anew. Datagrams
/// carry no signature, so a sender that forges the followed address and port, or that is first, can
/// still disturb the stream.
///
/// A larger run number of the followed sender begins anew at once. So do sixteen of its datagrams
/// in a row that fit nowhere else (a smaller run, another sensor, frames more than eight behind).
/// If a sensor is wanted, datagrams of another sensor never begin anew.
class FrameAssembler {
 public:
  explicit FrameAssembler(const WantedStream& wanted = {})
      : wanted_(wanted), sender_(wanted.from) {}

  /// Takes a datagram and appends to `frames` those that it completes or causes to be given up.
  void Take(std::span<const char> datagram,
            std::vector<ReceivedFrame>& frames,
            const DatagramOrigin& origin = {});
  /// Gives up the open frames when no further datagrams will come.
  void Flush(std::vector<ReceivedFrame>& frames);

  [[nodiscard]] const StreamCounts& counts() const { return counts_; }

 private:
  struct OpenFrame {
    std::vector<char> header;
    std::uint16_t points_each{};
    std::int64_t first_utc_ns{};
    std::int64_t last_utc_ns{};
    std::vector<bool> has_packet;
    std::vector<Arrival> arrivals;
    std::vector<char> points;  ///< In the order of arrival.
  };
  struct GivenFrame {
    std::uint32_t number{};
    std::vector<bool> had_packet;
  };
  enum class Place : std::uint8_t { kHere, kPast, kElsewhere };

  [[nodiscard]] bool IsOtherSensor(const StreamDatagram& datagram) const;
  [[nodiscard]] Place PlaceOf(const StreamDatagram& datagram) const;
  [[nodiscard]] bool BeginsAnew(const StreamDatagram& datagram);
  void CountPast(const StreamDatagram& datagram);
  void Store(const StreamDatagram& datagram,
             std::int64_t utc_ns,
             std::vector<ReceivedFrame>& frames);
  void GiveFirst(std::vector<ReceivedFrame>& frames);
  static ReceivedFrame Assemble(OpenFrame& open);

  WantedStream wanted_;
  StreamCounts counts_;
  FollowedSender sender_;
  bool has_run_ = false;
  std::uint32_t run_{};
  std::uint16_t sensor_{};
  std::uint32_t num_strays_{};  ///< Number of strays in a row.
  std::map<std::uint32_t, OpenFrame> open_;
  std::deque<GivenFrame> given_;                      ///< The frames that were given last.
  std::pair<std::uint32_t, std::uint16_t> furthest_;  ///< The furthest frame and packet so far.
};

}  // namespace railcast
