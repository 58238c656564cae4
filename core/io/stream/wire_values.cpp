#include "core/io/stream/wire_values.h"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

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

}  // namespace railcast
