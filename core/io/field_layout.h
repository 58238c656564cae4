#pragma once

#include <cstdint>
#include <type_traits>

#include "core/base/bytes.h"
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

}  // namespace railcast
