#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "railcast/io/stream.h"

namespace railcast {

/// The sender of a datagram and its time of arrival.
struct DatagramOrigin {
  Endpoint from{};
  std::int64_t time_ns{};  ///< By a monotonic clock.
  std::int64_t utc_ns{};   ///< The same by the time of day, since 1970.
};

/// The one sender that an assembler listens to: the first that it follows, until that has been
/// silent for kHold_ns.
class FollowedSender {
 public:
  /// Longer than any sender pauses between two frames, but short enough that the user need not wait
  /// long for a restarted sender, which has another port.
  static constexpr std::int64_t kHold_ns = 3'000'000'000;

  /// @param wanted Senders that this endpoint covers; absent: any.
  explicit FollowedSender(const std::optional<Endpoint>& wanted) : wanted_(wanted) {}

  /// Whether a datagram of this origin must have no effect.
  [[nodiscard]] bool IsAnother(const DatagramOrigin& origin) const {
    if (wanted_ && !wanted_->Covers(origin.from)) return true;
    return sender_ && *sender_ != origin.from && origin.time_ns - heard_ns_ < kHold_ns;
  }

  /// Follows the sender of a sound datagram; returns whether it takes the place of another one.
  /// @pre !IsAnother(origin)
  [[nodiscard]] bool Follow(const DatagramOrigin& origin) {
    const bool is_next = sender_ && *sender_ != origin.from;
    sender_ = origin.from;
    heard_ns_ = origin.time_ns;
    return is_next;
  }

 private:
  std::optional<Endpoint> wanted_;
  std::optional<Endpoint> sender_;
  std::int64_t heard_ns_{};  ///< Time of its last datagram.
};

/// Whether a run number is later than another. They are compared as serial numbers (RFC 1982), so
/// that a later run is recognised where the number wraps.
[[nodiscard]] inline bool IsLaterRun(std::uint32_t run, std::uint32_t than) {
  return static_cast<std::int32_t>(run - than) > 0;
}

/// Where the bytes of a datagram stand among those that have arrived.
struct Arrival {
  std::uint32_t packet{};
  std::size_t offset{};
  std::size_t size{};
};

/// Sorts arrivals by packet and returns their bytes in that order.
/// @param bytes In the order of arrival; a container of char, which is moved from if possible.
template <typename Bytes>
[[nodiscard]] Bytes JoinArrivals(std::vector<Arrival>& arrivals, Bytes& bytes) {
  if (std::ranges::is_sorted(arrivals, {}, &Arrival::packet)) return std::move(bytes);
  std::ranges::sort(arrivals, {}, &Arrival::packet);
  Bytes joined;
  joined.reserve(bytes.size());
  for (const Arrival& arrival : arrivals) {
    const auto begin = bytes.begin() + static_cast<std::ptrdiff_t>(arrival.offset);
    joined.insert(joined.end(), begin, begin + static_cast<std::ptrdiff_t>(arrival.size));
  }
  return joined;
}

}  // namespace railcast
