#pragma once

#include <nlohmann/json.hpp>

#include "railcast/structures.h"

namespace railcast {

/// The structure as in scenario files, without keys that have their defaults.
[[nodiscard]] nlohmann::ordered_json JsonOf(const StructureSpec& structure);

}  // namespace railcast
