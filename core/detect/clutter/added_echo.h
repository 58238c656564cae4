#pragma once

#include <cstddef>
#include <cstdint>

#include "core/detect/base/echo_tiles.h"
#include "core/detect/base/lane_random.h"

namespace railcast {

/// An echo weaker than a third of the threshold is detected in at most one case of 1000.
inline constexpr float kLeastStrayRatio = 0.3F;

/// An echo that no surface in the beam sends.
struct AddedEcho {
  std::uint32_t label{};
  std::uint32_t echo{};  ///< Its number within the firing.
  float range_m{};
  float power_ratio{};
  float intensity{};
  /// Half the range over which it is above the threshold (DetectTile::busy_m), if it comes after
  /// effect `saturation`.
  float busy_m = 0.0F;
};

/// The intensity of an echo of this power and range before attenuation by the air, as of a surface.
/// @param both_ways_per_m Twice the air's extinction coefficient.
[[nodiscard]] inline float IntensityInClearAir(float power_ratio,
                                               float power_min,
                                               float both_ways_per_m,
                                               float range_m) {
  return power_ratio * power_min * range_m * range_m * baseline::Exp(both_ways_per_m * range_m);
}

/// Adds an echo with the outcome `clutter` to the firing in lane `beam`. The receiver's loops have
/// still to detect and measure it.
EchoTiles::Place AddEcho(std::size_t beam, const AddedEcho& added, EchoTiles& echoes);

/// Adds an echo that is detected and measured already: its point lies at its range.
void AddMeasuredEcho(std::size_t beam, const AddedEcho& added, EchoTiles& echoes);

}  // namespace railcast
