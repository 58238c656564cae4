#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "railcast/error.h"

namespace railcast {

/// The name of one value of an enumeration in scenarios, schemas and messages.
template <class E>
struct EnumName {
  E value;
  std::string_view name;
};

/// The names of an enumeration's values, in the order in which messages list them. Each enumeration
/// that occurs in scenarios specialises this table beside its definition; reader, writer, schema
/// and messages all use it:
///
///   template <>
///   inline constexpr auto kEnumNames<SnowType> = std::to_array<EnumName<SnowType>>(
///       {{SnowType::kDry, "dry"}, {SnowType::kWet, "wet"}});
template <class E>
inline constexpr std::nullptr_t kEnumNames = nullptr;

/// An enumeration with a table of names.
template <class E>
concept NamedEnum =
    std::is_enum_v<E> && !std::is_null_pointer_v<std::remove_const_t<decltype(kEnumNames<E>)>>;

/// The name of a value.
/// @throws InputError if the value is not in the table.
template <NamedEnum E>
[[nodiscard]] std::string_view NameOf(E value) {
  for (const EnumName<E>& known : kEnumNames<E>) {
    if (known.value == value) return known.name;
  }
  throw InputError("must be a value of its enumeration (got " +
                   std::to_string(static_cast<long long>(value)) + ")");
}

/// The value of that name, or nothing if no value has it.
template <NamedEnum E>
[[nodiscard]] std::optional<E> ValueNamed(std::string_view name) {
  for (const EnumName<E>& known : kEnumNames<E>) {
    if (known.name == name) return known.value;
  }
  return std::nullopt;
}

/// All names of an enumeration, in the order of the table.
template <NamedEnum E>
[[nodiscard]] std::vector<std::string> NamesOf() {
  std::vector<std::string> names;
  for (const EnumName<E>& known : kEnumNames<E>) names.emplace_back(known.name);
  return names;
}

}  // namespace railcast
