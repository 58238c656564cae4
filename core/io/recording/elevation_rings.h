#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace railcast {

inline constexpr std::size_t kMaxRings = 256;

/// The ring of each point by its elevation, 0 the lowest, if the elevations lie in 2 to kMaxRings
/// clusters, each at most half as wide as the way to the next, that hold 98 % of the points; the
/// others belong to the nearest.
[[nodiscard]] std::optional<std::vector<std::uint32_t>> RingsByElevation(
    std::span<const double> elevations_rad);

}  // namespace railcast
