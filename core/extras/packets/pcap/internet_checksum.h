#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace railcast {

/// Adds 16-bit words, the last of which may lack its second byte, to the sum of RFC 1071.
[[nodiscard]] inline std::uint64_t AddWords(std::span<const char> bytes, std::uint64_t sum) {
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const auto byte = static_cast<unsigned char>(bytes[i]);
    sum += i % 2 == 0 ? std::uint64_t{byte} << 8U : byte;
  }
  return sum;
}

/// The checksum of RFC 1071.
[[nodiscard]] inline std::uint16_t ChecksumOf(std::uint64_t sum) {
  while (sum >> 16U != 0) sum = (sum & 0xFFFFU) + (sum >> 16U);
  return static_cast<std::uint16_t>(~sum);
}

}  // namespace railcast
