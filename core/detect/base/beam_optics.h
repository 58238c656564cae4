#pragma once

#include <vector>

#include "core/detect/base/detect_tile.h"
#include "railcast/effects.h"
#include "railcast/material.h"
#include "railcast/ray_caster.h"

namespace railcast {

/// Full width at half maximum of the pulse in metres of range: c x pulse length / 2, since the
/// light travels there and back.
[[nodiscard]] double PulseLength_m(const BeamSpec& beam);

/// Standard deviation of the received pulse in metres of range: PulseLength_m / (2 sqrt(2 ln 2)).
[[nodiscard]] double PulseSigma_m(const BeamSpec& beam);

/// The least detectable power, m^-2, as reflectance over range squared: 10 % at the data sheet's
/// range (docs/physics.md 1.2).
[[nodiscard]] double LeastPower(const ReceiverSpec& receiver);

/// How far behind an echo the receiver is blind: c x dead time / 2.
[[nodiscard]] double DeadLength_m(const ReceiverSpec& receiver);

/// Whether a surface that stretches the pulse (effect `pulse_stretch`) lowers the power that is
/// compared with the threshold: it does so for a receiver of peaks, not for one of energy.
[[nodiscard]] bool StretchLowersPower(const DetectorSpec& spec);

/// Whether the beam has a width in any direction; a ray has none.
[[nodiscard]] inline bool IsWide(const BeamSpec& beam) {
  return beam.divergence_mrad[0] > 0.0 || beam.divergence_mrad[1] > 0.0;
}

/// Standard deviations of the beam's Gaussian profile: a quarter of the full 1/e^2 angle.
[[nodiscard]] double HorizontalSigma_rad(const BeamSpec& beam);
[[nodiscard]] double VerticalSigma_rad(const BeamSpec& beam);

/// A surface's optics in the form that the loops of the effects need: a = d A and b = d B of Oren
/// and Nayar's qualitative model (1994), which for a viewer at the light source gives
/// d (A cos + B sin^2) with
///   A = 1 - 0.5 s^2 / (s^2 + 0.33),  B = 0.45 s^2 / (s^2 + 0.09),  s the facet slope in radians,
///   d = diffuse (1 - F0): light reflected at the surface does not reach the scatterers below it.
struct LaneOptics {
  float diffuse{};
  float a{};
  float b{};
  float f0{};
  float alpha2{};
  float retro{};
};
[[nodiscard]] LaneOptics LaneOpticsOf(const SurfaceOptics& optics);

/// The optics of every material at a sensor's wavelength, by material index.
/// @param wetness Wetness of the surfaces if effect surface_condition is on, else 0.
[[nodiscard]] std::vector<LaneOptics> OpticsTable(const std::vector<Material>& materials,
                                                  int wavelength_nm,
                                                  double wetness);

/// The surfaces that the rays' surface indices refer to.
struct SurfaceTable {
  const std::vector<Surface>& surfaces;
  const std::vector<LaneOptics>& optics;  ///< By material; empty if no physical effect is on.
};

/// Copies the hits of the rays into the detector's tile: surface, range, reflectivity, optics and a
/// preliminary outcome (no_surface, ego or returned), as one echo of the whole beam. Lane i of
/// `tile` is lane i of `rays`.
void ResolveHits(const RayTile& rays, const SurfaceTable& table, DetectTile& tile);

}  // namespace railcast
