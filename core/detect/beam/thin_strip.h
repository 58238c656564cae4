#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "core/detect/beam/sub_ray_pattern.h"

namespace railcast {

/// A place in a beam before its pattern is turned, in standard deviations of the profile.
struct BeamPlace {
  float h{}, v{};
};

/// A straight strip of a beam in which something thin lies, in standard deviations of the profile.
/// It reaches from one side of the beam to the other.
struct ThinStrip {
  BeamPlace direction;   ///< Unit direction along it.
  float begin{}, end{};  ///< Its sides: distances of Aside().

  /// Distance of a place from the line along the strip through the beam's middle, with a sign.
  [[nodiscard]] float Aside(const BeamPlace& place) const {
    return direction.h * place.v - direction.v * place.h;
  }
  /// The beam's share of power in it.
  [[nodiscard]] float Share() const;
  /// Whether a place is so near to a side that what lies there may reach beyond it.
  [[nodiscard]] bool IsAtSide(const BeamPlace& place) const;
};

/// Fits a strip to places at which sub-rays meet a surface: along the line of least squares of
/// distances from it, and as wide as the surface may reach.
/// @param share Of the beam, which these places stand for.
/// @return nothing for fewer than two places, or if they are not on a line.
[[nodiscard]] std::optional<ThinStrip> FitStrip(std::span<const BeamPlace> places, float share);

/// So many sets of sub-rays cover a strip, each by itself.
inline constexpr std::size_t kNumStripSets = kNumCloserSubRays / kNumSubRays;
/// The sub-rays of sets, each of kNumSubRays that have an equal share of a strip.
[[nodiscard]] BeamSubRays SubRaysIn(const ThinStrip& strip,
                                    std::size_t first_set,
                                    std::size_t num_sets);

}  // namespace railcast
