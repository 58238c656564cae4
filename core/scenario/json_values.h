#pragma once

#include <concepts>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include "core/scenario/json_rules.h"
#include "core/scenario/json_source.h"
#include "railcast/enum_names.h"

namespace railcast {

// Functions that read a JSON value into a value of a plain type. If there is a fault, they add it
// to the source and leave `value` at its default, so that reading can continue.
void ReadValue(JsonSource& source, const Node& node, bool& value, Anything);
void ReadValue(JsonSource& source, const Node& node, double& value, Anything);
void ReadValue(JsonSource& source, const Node& node, double& value, const Limits& limits);
void ReadValue(JsonSource& source, const Node& node, int& value, const NumberChoices& choices);
void ReadValue(JsonSource& source, const Node& node, std::string& value, Anything);
void ReadValue(JsonSource& source, const Node& node, std::string& value, ExistingFile);
void ReadValue(JsonSource& source, const Node& node, ObjectType& value, Anything);

/// Reads a string that must keep a rule.
template <class Rule>
requires requires(const Rule& rule, std::string_view text) {
  Broken(rule, text);
}
void ReadValue(JsonSource& source, const Node& node, std::string& value, const Rule& rule) {
  if (!node.json->is_string()) return source.Fault(node, "must be a string");
  const auto text = node.json->get<std::string>();
  if (const auto broken = Broken(rule, text)) return source.Fault(node, *broken);
  value = text;
}

/// Reads an integer within limits; returns nothing if the value is faulty.
[[nodiscard]] std::optional<std::uint64_t> ReadWhole(JsonSource& source,
                                                     const Node& node,
                                                     std::uint64_t at_least,
                                                     std::uint64_t at_most);

/// The integer types of specs. No spec has a negative integer.
template <class T>
concept WholeNumber = std::integral<T> && !std::same_as<T, bool>;

template <WholeNumber T>
void ReadValue(JsonSource& source, const Node& node, T& value, const Limits& limits) {
  constexpr std::uint64_t kMost = std::numeric_limits<T>::max();
  const std::uint64_t at_least = limits.at_least ? static_cast<std::uint64_t>(*limits.at_least) : 0;
  const std::uint64_t at_most =
      limits.at_most ? static_cast<std::uint64_t>(*limits.at_most) : kMost;
  const auto whole = ReadWhole(source, node, at_least, at_most);
  if (whole) value = static_cast<T>(*whole);
}

template <WholeNumber T>
void ReadValue(JsonSource& source, const Node& node, T& value, Anything) {
  ReadValue(source, node, value, Limits{});
}

/// Reads the name of an enumeration's value.
template <NamedEnum E>
void ReadValue(JsonSource& source, const Node& node, E& value, Anything) {
  std::string name(NameOf(value));
  ReadValue(source, node, name, OneOf(NamesOf<E>()));
  value = ValueNamed<E>(name).value_or(value);
}

/// Whether the node is a list of exactly, or of at least, `count` elements.
bool CheckListOf(JsonSource& source, const Node& node, std::size_t count);
bool CheckListOfAtLeast(JsonSource& source, const Node& node, const AtLeastElements& rule);

/// Whether the elements of a list that have the right type are within the limits.
bool CheckEachNumber(JsonSource& source, const Node& list, const EachNumber& rule);

}  // namespace railcast
