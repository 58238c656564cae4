#pragma once

#include <array>
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

}  // namespace railcast
