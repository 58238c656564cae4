#pragma once

#include <set>
#include <string>

#include "core/scenario/json_text.h"

namespace railcast {

/// The keys of scenarios that something drawn changes: "/weather/visibility_m".
/// @param name As records of approaches have it: a pointer stands for itself, the name of a group
///   for all that its options set or draw.
/// @param recipe The recipe's file.
[[nodiscard]] std::set<std::string> DrawnKeys(const std::string& name, const Json& recipe);

/// Whether a pointer is a key or lies below it.
[[nodiscard]] bool IsAtOrBelow(const std::string& pointer, const std::string& key);

}  // namespace railcast
