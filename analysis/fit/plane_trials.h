#pragma once

#include <vector>

#include "analysis/fit/known_planes.h"
#include "analysis/fit/truth_trials.h"

namespace railcast {

/// What planes make of a frame.
struct PlaneScene {
  std::vector<KnownPlane> planes;
  std::vector<std::uint16_t> surfaces;  ///< Of each plane.
  /// Whether noise moves points sideways, too: then it is measured square to the plane, else along
  /// the beam, which for such noise is sigma, and sigma / cos along the beam.
  bool is_isotropic{};
};

/// What pulse stretch leaves of the power of a beam on a plane (core/detect/incidence.h).
/// @param normal, direction Unit. @param range_m To where the beam meets it.
[[nodiscard]] double StretchOnPlane(const Vector3& normal,
                                    double range_m,
                                    const Vector3& direction,
                                    const BeamSpec& beam);

/// The trials of a frame: of every firing that looks at a plane, the first one it meets. Firings
/// look where their row and column do; residuals are taken along the point's own direction. A point
/// 0.5 m or more off is of something else. Without `facts.scan` only points make trials, each
/// looking where it lies, and nothing is lost.
void ForEachPlaneTrial(const RecordedFrame& recorded,
                       const PlaneScene& scene,
                       const SensorFacts& facts,
                       const TrialTaker& take);

}  // namespace railcast
