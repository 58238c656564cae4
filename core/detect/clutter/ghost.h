#pragma once

#include <cstdint>

#include "core/detect/base/echo_tiles.h"
#include "railcast/effects.h"

namespace railcast {

/// Effect `ghost`: points behind retroreflectors, at twice their range.
///
///   ghost's power ratio = q x power ratio of the retroreflector
///   q = ghost_reflectance (aperture / 2)^2 P_min x power ratio of the retroreflector
///
/// Lens and detector form a cat's eye: they send a share of the light that enters the aperture back
/// the way it came, to the retroreflector, and that sends it to the sensor again. The path is twice
/// as long. A retroreflector of effective reflectance rho at range R sends the irradiance
/// power rho / (pi R^2) back to a sensor that emits that power, hence the share
/// ghost_reflectance x aperture's area x rho / (pi R^2) = q goes on its way a second time, and what
/// becomes of it is what became of the first pulse. Air, the retroreflector's share of the beam and
/// pulse stretch therefore count twice, as they do in q. (In units of 1 / P_min, power ratio and
/// rho / R^2 are the same.)
///
/// The ghosts have a label of their own and the outcome `clutter`. They are weaker than their
/// retroreflectors (q is 1e-5 for sheeting at 10 m), so that return modes which report the
/// strongest echo alone hide them.
///
/// Validity: the strongest retroreflector of a beam; light that goes the way a third time (q^2),
/// and light that housing and window scatter back diffusely, are left out. Spots on the window
/// weaken the ghost as if it passed them once. Immutable; thread-safe.
class Ghost {
 public:
  explicit Ghost(const DetectorSpec& spec);

  [[nodiscard]] bool is_on() const { return gain_ > 0.0F; }
  /// Adds ghosts, one at most for each firing. They still have to be detected.
  void AddEchoes(EchoTiles& echoes) const;

 private:
  std::uint32_t label_;
  float power_min_;
  float gain_{};  // q over the power ratio; 0 if the effect is off.
  float range_min_m_;
};

}  // namespace railcast
