#include "core/io/stream/wire_values.h"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "railcast/io/stream.h"

namespace railcast {

using namespace stream_layout;

bool IsPose(const WirePose& pose) {
  // Allows for quaternions rounded to float32.
  constexpr double kNormTolerance = 1e-6;
  const double norm2 =
      pose[3] * pose[3] + pose[4] * pose[4] + pose[5] * pose[5] + pose[6] * pose[6];
  return std::ranges::all_of(pose, [](double value) { return std::isfinite(value); }) &&
         std::abs(norm2 - 1.0) < kNormTolerance;
}

bool IsChecksumRight(std::span<const char> datagram) {
  const std::size_t checked = datagram.size() - kTrailerSize;
  const auto crc = ::crc32_z(0, reinterpret_cast<const unsigned char*>(datagram.data()), checked);
  return Get<std::uint32_t>(&datagram[checked]) == crc;
}

std::optional<std::uint32_t> CountEach(const ShareOfWhole& share) {
  if (share.packet >= share.num_packets) return std::nullopt;
  const std::uint64_t num_full = share.num_packets - 1U;
  std::uint64_t each = share.here;
  if (share.packet == num_full) {
    if (share.first + share.here != share.total) return std::nullopt;
    if (num_full > 0) each = share.first / num_full;
  }
  const bool is_placed = share.first == each * share.packet;
  const bool is_counted =
      num_full == 0 || (each * num_full < share.total && share.total <= each * (num_full + 1));
  // `each` exceeds what a datagram holds where a last datagram misstates `first`.
  if (!is_placed || !is_counted || each > kMaxStreamDatagram) return std::nullopt;
  return static_cast<std::uint32_t>(each);
}

}  // namespace railcast
