#pragma once

#include <cstring>

namespace railcast {

/// Writes one value, converted to `Stored`, at an address of any alignment.
template <typename Stored, typename T>
void StoreAt(char* place, T value) {
  const auto stored = static_cast<Stored>(value);
  std::memcpy(place, &stored, sizeof stored);
}

/// Reads a number at an address of any alignment.
template <typename Number>
[[nodiscard]] Number LoadAt(const char* place) {
  Number number{};
  std::memcpy(&number, place, sizeof number);
  return number;
}

}  // namespace railcast
