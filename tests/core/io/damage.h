#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <string>

namespace railcast {

/// Returns the text with the first occurrence of `from` replaced by `to`.
[[nodiscard]] inline std::string Replaced(std::string text,
                                          const std::string& from,
                                          const std::string& to) {
  const std::size_t place = text.find(from);
  EXPECT_NE(place, std::string::npos) << from;
  return text.replace(place, from.size(), to);
}

/// Returns the bytes with some bits of one byte flipped.
[[nodiscard]] inline std::string Flipped(std::string bytes, std::size_t place) {
  bytes[place] = static_cast<char>(bytes[place] ^ 0x15);
  return bytes;
}

}  // namespace railcast
