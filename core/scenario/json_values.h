#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/scenario/archive.h"
#include "core/scenario/json_source.h"

namespace railcast {

// Functions that read a JSON value into a value of a plain type. If there is a fault, they add it
// to the source and leave `value` at its default, so that reading can continue.
void ReadBool(JsonSource& source, const Node& node, bool& value);
/// @param rule Limits or none.
void ReadNumber(JsonSource& source, const Node& node, double& value, const RuleRef& rule);
/// @param rule Limits, NumberChoices or none.
void ReadWhole(JsonSource& source, const Node& node, const ValueRef& value, const RuleRef& rule);
void ReadSigned(JsonSource& source, const Node& node, std::int64_t& value);
/// @param rule One of those for texts, or none.
void ReadText(JsonSource& source, const Node& node, std::string& value, const RuleRef& rule);
/// Reads the name of an enumeration's value.
void ReadName(JsonSource& source, const Node& node, const ValueRef& value);
void ReadObjectType(JsonSource& source, const Node& node, ObjectType& value);

/// Whether the node is a list of exactly, or of at least, `count` elements.
bool CheckListOf(JsonSource& source, const Node& node, std::size_t count);
bool CheckListOfAtLeast(JsonSource& source, const Node& node, const AtLeastElements& rule);

/// Whether the elements of a list that have the right type are within the limits.
bool CheckEachNumber(JsonSource& source, const Node& list, const EachNumber& rule);

}  // namespace railcast
