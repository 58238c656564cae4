#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string_view>
#include <vector>

#include "core/detect/beam_optics.h"
#include "core/detect/clutter.h"
#include "core/detect/detect_tile.h"
#include "core/detect/detector_spec.h"
#include "core/detect/echo_tiles.h"
#include "core/detect/effect_parameters.h"
#include "core/detect/kernels.h"

namespace railcast {

/// One effect's pass over a tile.
struct EffectStep {
  std::string_view effect;
  std::function<void(DetectTile&)> apply;
};

/// Called after each effect, with its name.
using EffectObserver = std::function<void(std::string_view effect)>;

/// Whether any effect of the physical rungs is on.
[[nodiscard]] bool IsPhysical(const EffectSet& effects);

/// Turns hits into returns: the effects that are on. The published ones in the published order
/// (threshold, rain, snow, then noise on all points); the physical ones in the order of physics
/// (surface response, pulse stretch, extinction, clutter, sunlight, detection, then range and
/// noise). Immutable; thread-safe.
class Detector {
 public:
  /// @param kernels The instruction set's loops; the result does not depend on the choice.
  explicit Detector(const DetectorSpec& spec, const Kernels& kernels = AvailableKernels().back());
  // Its steps point into it.
  Detector(Detector&&) = default;
  Detector& operator=(Detector&&) = default;

  /// Surface and air: expects all of a DetectTile that comes before `outcome`, and outcome
  /// (no_surface, ego or returned); fills intensity and power_ratio. Every component of a wide beam
  /// passes through these effects by itself.
  void Respond(DetectTile& tile, const EffectObserver& observer = {}) const;
  /// The same of one thing alone, without stretch: a wire, which no ray has hit.
  /// @param cosine Of the incidence.
  [[nodiscard]] float Reflectance(const LaneOptics& optics, float cosine) const;
  /// Power over the least detectable one.
  /// @param intensity Share of the beam x effective reflectance.
  [[nodiscard]] float PowerRatio(float intensity, float range_m, float spread_m) const;

  /// Receiver: expects intensity and power_ratio too, adds what answers without a surface, and
  /// fills the rest.
  void Detect(EchoTiles& echoes, const EffectObserver& observer = {}) const;

 private:
  void AddOptics(const Kernels& kernels);

  ResponseParameters response_;
  float pulse_sigma_m_;
  bool has_stretch_;
  float extinction_per_m_;
  std::vector<EffectStep> optics_;
  std::vector<EffectStep> receiver_;
  std::vector<float> channel_bias_m_;
  Clutter clutter_;
};

}  // namespace railcast
