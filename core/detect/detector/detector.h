#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string_view>
#include <vector>

#include "core/detect/base/beam_optics.h"
#include "core/detect/base/detect_tile.h"
#include "core/detect/base/echo_tiles.h"
#include "core/detect/base/effect_parameters.h"
#include "core/detect/clutter/bright_echo.h"
#include "core/detect/clutter/clutter.h"
#include "core/detect/detector/effect_table.h"
#include "core/detect/kernels/kernels.h"
#include "railcast/effects.h"

namespace railcast {

/// Callback after each effect, with the effect's name.
using EffectObserver = std::function<void(std::string_view effect)>;

/// Whether effect `surface_condition` changes any surface: it is on, and surfaces are wet or
/// covered with snow.
[[nodiscard]] bool ShowsSurfaceCondition(const DetectorSpec& spec);

/// The parameters of effect `edge_loss`.
struct EdgeLossParameters {
  std::uint64_t seed{};
  float probability{};  ///< For beams halved by a high edge; 0 = the effect is off.
  float pulse_length_m{};
};

/// Effect `edge_loss`: a receiver that compares parts of its pulse with each other, or several
/// pulses, may find no distance in a beam that meets two surfaces. It loses all echoes of a beam
/// whose two largest shares s1 >= s2 are a distance d apart in range with the probability
///
///   edge_loss x 2 s2 / (s1 + s2) x (1 - L / d)   for d > the pulse's length L, else 0
///
/// Ours: recordings show that beams are lost at jumps of metres (docs/physics.md 1.3), not by which
/// law; this one rises with the smaller share and the jump, and is 0 where pulses overlap.
void LoseBeamsAtEdges(const EdgeLossParameters& parameters, EchoTiles& echoes);

/// Turns hits into detected echoes. Runs the loops of the effects that are on and have a cause, in
/// the order of StepOrder; clutter is added before the receiver's loops, false alarms and foreign
/// pulses after them. Immutable; thread-safe.
class Detector {
 public:
  /// @param kernels The loops of one instruction set; the result does not depend on the choice.
  explicit Detector(const DetectorSpec& spec,
                    const DetectorSetting& setting = {},
                    const Kernels& kernels = AvailableKernels().back());
  // Not copyable: the steps point to the elements of channel_bias_m_, which moving keeps in place.
  Detector(Detector&&) = default;
  Detector& operator=(Detector&&) = default;

  /// Applies the effects of surface and air. Expects all members of the tile up to and including
  /// `outcome` (no_surface, ego or returned); fills intensity and power_ratio. Every component of a
  /// wide beam passes through these effects on its own.
  void Respond(DetectTile& tile, const EffectObserver& observer = {}) const;
  /// The response of the surfaces without snow on them, for the explanation of a firing. Runs only
  /// the first step of Respond(), which then overwrites the result.
  /// @pre ShowsSurfaceCondition()
  void RespondBare(DetectTile& tile, const EffectObserver& observer) const;
  /// Effective reflectance of a single surface, for wires, which no ray has hit.
  /// @param cosine Cosine of incidence.
  [[nodiscard]] float Reflectance(const LaneOptics& optics, float cosine) const;
  /// Received power of a single echo over the least detectable power, with pulse stretch and
  /// extinction where those effects are on.
  /// @param intensity Share of the beam x effective reflectance.
  [[nodiscard]] float PowerRatio(float intensity, float range_m, float spread_m) const;

  /// Applies the effects of the receiver. Also expects intensity and power_ratio; adds clutter and
  /// false alarms and fills the remaining members.
  /// @param air The rays of the firings in the lanes of `echoes.first`.
  void Detect(const AirView& air, EchoTiles& echoes, const EffectObserver& observer = {}) const;

 private:
  ResponseParameters response_;
  float pulse_sigma_m_;
  bool stretch_lowers_power_;
  float extinction_per_m_;
  EffectStep bare_response_;
  std::vector<EffectStep> optics_;
  std::vector<EffectStep> receiver_;
  std::vector<float> channel_bias_m_;
  Clutter clutter_;
  Ghost ghost_;
  EdgeLossParameters edge_loss_;
  Interference interference_;
};

}  // namespace railcast
