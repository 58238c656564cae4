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
void ReadValue(JsonSource& source, const Node& node, std::string& value, Anything);
void ReadValue(JsonSource& source, const Node& node, std::string& value, NonEmptyString rule);
void ReadValue(JsonSource& source, const Node& node, std::string& value, const Choices& choices);
void ReadValue(JsonSource& source, const Node& node, std::string& value, HostAndPort rule);
void ReadValue(JsonSource& source, const Node& node, std::string& value, ExistingFile);

/// A whole number within limits; nothing if it is none.
[[nodiscard]] std::optional<std::uint64_t> ReadWhole(JsonSource& source,
                                                     const Node& node,
                                                     std::uint64_t at_least,
                                                     std::uint64_t at_most);

template <std::unsigned_integral T>
void ReadValue(JsonSource& source, const Node& node, T& value, const Limits& limits) {
  const std::uint64_t at_least = limits.at_least ? static_cast<std::uint64_t>(*limits.at_least) : 0;
  const auto whole = ReadWhole(source, node, at_least, std::numeric_limits<T>::max());
  if (whole) value = static_cast<T>(*whole);
}

template <std::unsigned_integral T>
void ReadValue(JsonSource& source, const Node& node, T& value, Anything) {
  ReadValue(source, node, value, Limits{});
}

/// Whether the node is a list of exactly, or of at least, `count` elements.
bool CheckListOf(JsonSource& source, const Node& node, std::size_t count);
bool CheckListOfAtLeast(JsonSource& source, const Node& node, const AtLeastElements& rule);

}  // namespace railcast
