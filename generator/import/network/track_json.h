#pragma once

#include <nlohmann/json.hpp>

#include "railcast/world_spec.h"

namespace railcast {

/// A track as scenario files have it.
[[nodiscard]] nlohmann::ordered_json JsonOf(const TrackSpec& track);

}  // namespace railcast
