#pragma once

#include "railcast/rail_world.h"

namespace railcast {

/// System height of the contact line in tunnels and below bridges, if it is higher elsewhere.
/// The messenger sags 0.69 m in a span of 65 m and must stay 0.3 m above the contact wire.
inline constexpr double kLowSystemHeight_m = 1.1;

/// System height of the contact line at a chainage: lower in tunnels and below bridges, and from
/// one span before to one span behind them.
[[nodiscard]] double SystemHeightAt_m(const WorldSpec& world, double s_m);

}  // namespace railcast
