#pragma once

#include "railcast/world_spec.h"

namespace railcast {

/// Weight, tension and sag of the contact line (docs/physics.md 7.2): a Bz50 messenger wire carries
/// an AC-100 contact wire at 10 kN.
inline constexpr double kWireWeight_n_per_m = 13.0;
inline constexpr double kMessengerTension_n = 10e3;
inline constexpr double kContactTension_n = 10e3;
inline constexpr double kContactPresag = 1.0 / 1000.0;  ///< Sag as a fraction of the span.

/// Whether any track has a contact line.
[[nodiscard]] bool HasContactLine(const WorldSpec& world);

/// The least system height with which the messenger wire, sagging over the longest span, stays 0.3
/// m above the contact wire.
[[nodiscard]] double LeastSystemHeight_m(const WorldSpec& world);

/// @throws InputError if the messenger wire would sag to less than 0.3 m above the contact wire:
///   "/catenary/system_height_m: rule (got value)", relative to the world's JSON object.
void CheckSystemHeight(const WorldSpec& world);

/// System height of the contact line in tunnels and below bridges, if it is higher elsewhere.
/// The messenger sags 0.69 m in a span of 65 m and must stay 0.3 m above the contact wire.
inline constexpr double kLowSystemHeight_m = 1.1;

/// System height of the contact line at a chainage: lower in tunnels and below bridges, and from
/// one span before to one span behind them.
[[nodiscard]] double SystemHeightAt_m(const WorldSpec& world, double s_m);

}  // namespace railcast
