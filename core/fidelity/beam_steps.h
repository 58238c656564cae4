#pragma once

#include <vector>

#include "railcast/effects.h"
#include "railcast/frame.h"
#include "railcast/simulator.h"

namespace railcast {

/// Steps within beams: surfaces 0.05 to 0.5 m one behind the other. Pulses of 5 ns merge below 0.64
/// m, so that such beams give one echo, whose range lies between the surfaces. A frame of the
/// sensor's own pulses does not show them; one of pulses of 0.2 ns, which are resolved from 0.03 m
/// on, does.
struct StepLimits {
  /// Echoes with a smaller share of the beam are left out.
  float least_share{};
  float least_m{};
  float most_m{};
  /// Echoes of one sloping surface are no step: their distance must be more than this times the
  /// standard deviation of the range that the slope gives a whole beam.
  float least_spreads{};
};

/// What counts as a step in the reference ...
inline constexpr StepLimits kReferenceSteps{0.05F, 0.05F, 0.5F, 4.0F};
/// ... and in a frame that is compared with it. Half and twice as much, so that what the reference
/// has is not missed for lying at a limit; any share of the beam will do.
inline constexpr StepLimits kFoundSteps{1e-3F, 0.025F, 1.0F, 2.0F};

/// The spec with which a frame shows the parts of its beams as echoes: short pulses, all of which
/// are detected, in clear air. The beams and their sub-rays stay those of `spec`, but for a
/// reference of more than 256 sub-rays, which are enough to find parts of 5 %.
[[nodiscard]] SimulatorSpec ShowParts(SimulatorSpec spec);

/// By firing: the largest step within the beam; NaN if it has none.
/// @param parts A frame simulated with ShowParts().
[[nodiscard]] std::vector<float> StepsOf(const Frame& parts,
                                         const BeamSpec& beam,
                                         const StepLimits& limits);

}  // namespace railcast
