#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <sstream>
#include <string>
#include <string_view>

namespace railcast {

/// Writes a fingerprint of bytes to the results of the running test, so that scripts/dev/arm64.sh
/// can compare two kinds of processors, which no test can do alone.
/// @param name Unique in the test; "bytes_of_" precedes it.
inline void RecordBytes(const std::string& name, std::string_view bytes) {
  // FNV-1a with 64 bits.
  std::uint64_t hash = 0xcbf29ce484222325U;
  for (const char byte : bytes) {
    hash = (hash ^ static_cast<unsigned char>(byte)) * 0x100000001b3U;
  }
  std::ostringstream text;
  text << std::hex << hash;
  testing::Test::RecordProperty("bytes_of_" + name, text.str());
}

/// As above, of a value without pointers and with its padding set.
template <typename T>
void RecordBytesOf(const std::string& name, const T& value) {
  RecordBytes(name, {reinterpret_cast<const char*>(&value), sizeof value});
}

}  // namespace railcast
