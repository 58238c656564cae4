#pragma once

#include <zlib.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>

namespace railcast {

/// Gives a datagram a valid CRC, which random bytes would never have.
inline void SealDatagram(std::string& datagram) {
  constexpr std::size_t kCrcSize = 4;
  if (datagram.size() < kCrcSize) return;
  const std::size_t checked = datagram.size() - kCrcSize;
  const auto crc = static_cast<std::uint32_t>(
      ::crc32_z(0, reinterpret_cast<const unsigned char*>(datagram.data()), checked));
  std::memcpy(datagram.data() + checked, &crc, kCrcSize);
}

/// Calls `take` with each datagram of a fuzzer's input. A datagram is preceded by its length in 15
/// bits; the 16th bit requests a valid CRC.
/// @returns The number of datagrams.
template <typename Take>
std::uint64_t ForEachDatagram(std::span<const char> input, const Take& take) {
  constexpr unsigned kSealed = 0x8000;
  std::uint64_t num_datagrams = 0;
  while (input.size() >= 2) {
    std::uint16_t head = 0;
    std::memcpy(&head, input.data(), sizeof head);
    const auto part = input.subspan(2, std::min<std::size_t>(input.size() - 2, head & ~kSealed));
    std::string datagram(part.begin(), part.end());
    if ((head & kSealed) != 0) SealDatagram(datagram);
    take(datagram);
    ++num_datagrams;
    input = input.subspan(2 + part.size());
  }
  return num_datagrams;
}

}  // namespace railcast
