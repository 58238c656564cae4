#pragma once

#include <nlohmann/json.hpp>

#include "railcast/rail_world.h"

namespace railcast {

/// A track as scenario files have it.
[[nodiscard]] nlohmann::ordered_json JsonOf(const TrackSpec& track);

}  // namespace railcast
