#pragma once

#include <vector>

#include "core/detect/detect_spec.h"
#include "core/scene/material.h"

namespace railcast {

/// The pulse's length in metres of range, there and back: c x pulse length / 2, full width at half
/// maximum.
[[nodiscard]] double PulseLength_m(const BeamSpec& beam);

/// Standard deviation of the received pulse in metres of range: its length over 2 sqrt(2 ln 2).
[[nodiscard]] double PulseSigma_m(const BeamSpec& beam);

/// The least detectable power, m^-2, as reflectance over range squared: 10 % at the data sheet's
/// range (physics.md 0).
[[nodiscard]] double LeastPower(const ReceiverSpec& receiver);

/// Standard deviations of the beam's Gaussian profile: a quarter of the full 1/e^2 angle.
[[nodiscard]] double HorizontalSigma_rad(const BeamSpec& beam);
[[nodiscard]] double VerticalSigma_rad(const BeamSpec& beam);

/// A surface's optics as the effects' loops want them: a = d A and b = d B of Oren and Nayar's
/// qualitative model (1994), seen from the source: d (A cos + B sin^2) with
///   A = 1 - 0.5 s^2 / (s^2 + 0.33),  B = 0.45 s^2 / (s^2 + 0.09),  s the facet slope in radians,
///   d = diffuse (1 - F0): what the surface reflects at once never reaches what scatters below.
struct LaneOptics {
  float diffuse{};
  float a{};
  float b{};
  float f0{};
  float alpha2{};
  float retro{};
};
[[nodiscard]] LaneOptics LaneOpticsOf(const SurfaceOptics& optics);

/// What every material looks like to a sensor, by material index.
/// @param wetness Of effect surface_condition, else 0.
[[nodiscard]] std::vector<LaneOptics> OpticsTable(const std::vector<Material>& materials,
                                                  int wavelength_nm,
                                                  double wetness);

}  // namespace railcast
