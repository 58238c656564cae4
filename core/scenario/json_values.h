#pragma once

#include <concepts>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include "core/scenario/json_rules.h"
#include "core/scenario/json_source.h"

namespace railcast {

// How a JSON value becomes a value of a plain type. Faults go to the source; `value` keeps its
// default then, and reading goes on.
void ReadValue(JsonSource& source, const Node& node, bool& value, Anything);
void ReadValue(JsonSource& source, const Node& node, double& value, Anything);
void ReadValue(JsonSource& source, const Node& node, double& value, const Limits& limits);
void ReadValue(JsonSource& source, const Node& node, int& value, const NumberChoices& choices);
void ReadValue(JsonSource& source, const Node& node, std::string& value, Anything);
void ReadValue(JsonSource& source, const Node& node, std::string& value, NonEmptyString rule);
void ReadValue(JsonSource& source, const Node& node, std::string& value, OneLine rule);
void ReadValue(JsonSource& source,
               const Node& node,
               std::string& value,
               const AllowedNames& choices);
void ReadValue(JsonSource& source, const Node& node, std::string& value, HostAndPort rule);
void ReadValue(JsonSource& source, const Node& node, std::string& value, ExistingFile);

/// A whole number within limits; nothing if it is none.
[[nodiscard]] std::optional<std::uint64_t> ReadWhole(JsonSource& source,
                                                     const Node& node,
                                                     std::uint64_t at_least,
                                                     std::uint64_t at_most);

/// A whole number. No spec has a negative one.
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

/// Whether the node is a list of exactly, or of at least, `count` elements.
bool CheckListOf(JsonSource& source, const Node& node, std::size_t count);
bool CheckListOfAtLeast(JsonSource& source, const Node& node, const AtLeastElements& rule);

/// Whether the elements of a list, as far as they are what they must be, keep the limits.
bool CheckEachNumber(JsonSource& source, const Node& list, const EachNumber& rule);

}  // namespace railcast
