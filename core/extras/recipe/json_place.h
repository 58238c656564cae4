#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "core/scenario/json_text.h"

namespace railcast {

/// Why a text is no JSON pointer (RFC 6901) to a place below the root; nothing if it is one.
[[nodiscard]] std::optional<std::string> PointerFault(std::string_view pointer);

/// Whether the place `inner` is `outer` or lies inside it.
[[nodiscard]] bool LiesWithin(std::string_view inner, std::string_view outer);

/// Sets the value at a place. Objects on the way that do not exist are made; elements of lists must
/// exist. A key replaces the other one of two that exclude each other: visibility_m and
/// fog_density_per_m, rain_intensity and rain_rate_mmph, track and route, profile and path, lidar
/// and lidars.
/// @return What stands in the way: "has no element 3"; nothing if it is set.
[[nodiscard]] std::optional<std::string> SetAt(Json& root,
                                               std::string_view pointer,
                                               const Json& value);

}  // namespace railcast
