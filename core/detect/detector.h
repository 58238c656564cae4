#pragma once

#include <cstdint>
#include <functional>
#include <string_view>
#include <vector>

#include "core/detect/detect_spec.h"
#include "core/detect/detect_tile.h"
#include "core/detect/kernels.h"

namespace railcast {

/// What a Detector depends on.
struct DetectorSpec {
  std::uint64_t seed = 1;
  double range_min_m = 0.5;
  double range_max_m = 300.0;
  EffectSet effects{};
  PlausibilitySpec plausibility{};
  WeatherSpec weather{};
};

/// Turns hits into returns: the effects that are on, in the order of the published model
/// (threshold, rain, snow, then noise on all points). Immutable; thread-safe.
class Detector {
 public:
  /// @param kernels The instruction set's loops; the result does not depend on the choice.
  explicit Detector(const DetectorSpec& spec, const Kernels& kernels = AvailableKernels().back());

  /// One effect's pass over a tile.
  struct Step {
    std::string_view effect;
    std::function<void(DetectTile&)> apply;
  };
  /// The passes of this detector in their order; `Run` makes them all.
  [[nodiscard]] const std::vector<Step>& steps() const { return steps_; }

  /// Expects firing, direction, true_range_m, cos_incidence, reflectivity and outcome (no_surface,
  /// ego or returned), and fills the rest.
  void Run(DetectTile& tile) const;

 private:
  std::vector<Step> steps_;
};

}  // namespace railcast
