#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "core/io/stream/stream_layout.h"

namespace railcast {

/// A pose as datagrams carry it: x y z qx qy qz qw.
using WirePose = std::array<double, stream_layout::kNumPoseValues>;

/// Whether the values are finite and the quaternion is a rotation.
[[nodiscard]] bool IsPose(const WirePose& pose);

/// Whether the last four bytes of a datagram are the CRC of those before them.
/// @pre The datagram has at least four bytes.
[[nodiscard]] bool IsChecksumRight(std::span<const char> datagram);

/// What a datagram says of its share of a whole: of a frame's points, or of an image's bytes.
struct ShareOfWhole {
  std::uint64_t total{};  ///< In the whole.
  std::uint64_t first{};  ///< Place of this datagram's first one.
  std::uint64_t here{};   ///< In this datagram.
  std::uint32_t packet{};
  std::uint32_t num_packets{};
};

/// Returns how many each datagram of the whole but the last holds, at most kMaxStreamDatagram, or
/// nothing if the counts contradict each other.
[[nodiscard]] std::optional<std::uint32_t> CountEach(const ShareOfWhole& share);

}  // namespace railcast
