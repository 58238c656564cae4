// See vector_math.h for why this header has no `#pragma once`.
#ifndef RAILCAST_DETECT_SURFACE_RESPONSE_H_
#define RAILCAST_DETECT_SURFACE_RESPONSE_H_

#include <cmath>

#include "core/detect/base/beam_optics.h"
#include "core/detect/base/detect_tile.h"
#include "core/detect/base/effect_parameters.h"
#include "core/detect/base/vector_math.h"

namespace railcast {

struct PulseStretchParameters {
  float pulse_sigma_m{};
  bool lowers_power{};  ///< As StretchLowersPower().
  bool moves_peak{};    ///< Whether beams of one hit lie on its plane: effect `footprint` looks.
};

}  // namespace railcast

namespace railcast::RAILCAST_ISA {

/// Effective reflectance of a GGX lobe seen from the light source, with Smith's shadowing both
/// ways: pi F0 D G / (4 cos) (Walter et al. 2007, "Microfacet models for refraction through rough
/// surfaces", eqs. 33, 34; the half vector is the beam itself, so that Fresnel's term is F0).
///
/// GGX has facets of every slope up to 90 deg; real surfaces do not. At 86 deg a polished rail
/// (F0 0.6, alpha 0.1) would have a reflectance of 0.012, more than twice that of its diffuse part.
/// Therefore the lobe is multiplied by 2 cos^2 beyond 45 deg (the taper is our own).
[[nodiscard]] inline float MonostaticGgx(float cosine, float f0, float alpha2) {
  const float c2 = cosine * cosine;
  const float d = c2 * (alpha2 - 1.0F) + 1.0F;
  const float g = cosine + std::sqrt(alpha2 + (1.0F - alpha2) * c2);
  const float taper = 2.0F * c2 < 1.0F ? 2.0F * c2 : 1.0F;
  return taper * f0 * alpha2 * cosine / (g * g * d * d);
}

/// Effective reflectance of a surface: its response relative to a white Lambertian surface at
/// normal incidence, as the sum of
///
///   diffuse   rho (1 - F0) (A cos + B sin^2)     Oren and Nayar 1994, seen from the source
///   specular  pi F0 D_ggx G / (4 cos)            x min(1, 2 cos^2)
///   retro     rho_retro cos^5                    half of it at an entrance angle of 30 deg
[[nodiscard]] inline float EffectiveReflectance(const LaneOptics& optics, float cosine) {
  const float c2 = cosine * cosine;
  return optics.a * cosine + optics.b * (1.0F - c2) +
         MonostaticGgx(cosine, optics.f0, optics.alpha2) + optics.retro * c2 * c2 * cosine;
}

/// Effect `surface_response`: computes the effective reflectance rho of the surface at its angle of
/// incidence, and the ratio of received to least detectable power: share rho / R^2 / P_min with
/// P_min = 0.1 / R0^2, R0 the data sheet's range at 10 %. If the effect is off, Lambert's law
/// (reflectivity x cos) replaces the effective reflectance.
///
/// Snow (part of effect `surface_condition`) covers snow_cover of each face less steep than 45 deg.
inline void ApplyResponse(DetectTile& tile, const ResponseParameters& parameters) {
  const ResponseParameters p = parameters;  // The copy cannot alias the tile.
  constexpr float kCos45 = 0.70710678F;
  for (std::size_t i = 0; i < tile.num_rays; ++i) {
    const float c = tile.cos_incidence[i];
    const float c2 = c * c;
    float rho = tile.reflectivity[i] * c;
    if (!p.is_lambert) {
      rho = EffectiveReflectance({tile.reflectivity[i], tile.diffuse_a[i], tile.diffuse_b[i],
                                  tile.specular_f0[i], tile.specular_alpha2[i], tile.retro[i]},
                                 c);
    }
    const float covered = tile.normal_up[i] >= kCos45 ? p.snow_cover : 0.0F;
    rho += covered * (p.snow_a * c + p.snow_b * (1.0F - c2) - rho);
    const float range_m = tile.true_range_m[i];
    tile.intensity[i] = tile.share[i] * rho;
    tile.power_ratio[i] = tile.share[i] * rho * p.inverse_power_m2 / (range_m * range_m);
  }
}

/// Effect `pulse_stretch`: a surface oblique to the beam stretches the pulse. The echo's peak is
/// lower, power x s / hypot(s, spread), and nearer than the surface is on the beam's axis, since
/// the near part of the beam is brighter and more of it answers at once (s: the pulse's sigma in
/// metres of range; Gaussian pulse, Gaussian beam):
///
///   peak = R 2 / (1 + sqrt(1 + 4 c q)),  q = spread^2 / R^2,
///   c    = 1 + k + 3 spread^2 / (s^2 + spread^2),  k = d ln(rho_eff) / d ln(cos)
///
/// where R / (1 + x), x normal of variance q, is the range over the plane and (1 + x)^(2 + k) its
/// power. This is the power's mean range for spread << s and its mode for spread >> s, to the first
/// order in q between, and holds where the whole beam lies on the plane. k is 1 for Lambert and
/// that of the diffuse part for Oren and Nayar.
inline void ApplyPulseStretch(DetectTile& tile, const PulseStretchParameters& parameters) {
  const PulseStretchParameters p = parameters;  // The copy cannot alias the tile.
  const float s2 = p.pulse_sigma_m * p.pulse_sigma_m;
  for (std::size_t i = 0; i < tile.num_rays; ++i) {
    const float range_m = tile.true_range_m[i];
    const float cosine = tile.cos_incidence[i];
    const float spread2 = tile.spread_m[i] * tile.spread_m[i];
    const float lowered = std::sqrt(s2 / (s2 + spread2));
    const float by_cosine = tile.diffuse_a[i] * cosine;
    const float all = by_cosine + tile.diffuse_b[i] * (1.0F - cosine * cosine);
    const float power = all > 0.0F ? by_cosine / all : 1.0F;
    const float nearer = 1.0F + power + 3.0F * spread2 / (s2 + spread2);
    const float root = std::sqrt(1.0F + 4.0F * nearer * spread2 / (range_m * range_m));
    const float shift_m = range_m * (1.0F - root) / (1.0F + root);
    // The comparison is false where nothing was hit.
    tile.peak_shift_m[i] = ((range_m > 0.0F) & p.moves_peak) ? shift_m : 0.0F;
    tile.power_ratio[i] *= p.lowers_power ? lowered : 1.0F;
  }
}

}  // namespace railcast::RAILCAST_ISA

#endif  // RAILCAST_DETECT_SURFACE_RESPONSE_H_
