#include "core/io/content_hash.h"

#include <xxhash.h>

#include <array>
#include <cstdint>

namespace railcast {

std::string ContentHash(std::string_view bytes) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  const std::uint64_t hash = XXH3_64bits(bytes.data(), bytes.size());
  std::string text(16, '0');
  for (std::size_t i = 0; i < text.size(); ++i) {
    text[i] = kDigits[static_cast<std::size_t>((hash >> (60U - 4U * i)) & 0xFU)];
  }
  return text;
}

}  // namespace railcast
