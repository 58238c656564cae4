#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "railcast/outcome.h"

namespace railcast {

/// The arithmetic type in which a file stores a Frame field of element type T.
template <typename T>
struct StoredType {
  using Type = T;
};
template <>
struct StoredType<Outcome> {
  using Type = std::uint8_t;
};

/// The element type of a field's values.
template <typename Values>
using ElementOf = typename std::remove_cvref_t<Values>::value_type;

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
