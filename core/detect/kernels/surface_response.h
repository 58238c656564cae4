// See vector_math.h for why this header has no `#pragma once`.
#ifndef RAILCAST_DETECT_SURFACE_RESPONSE_H_
#define RAILCAST_DETECT_SURFACE_RESPONSE_H_

#include <cmath>

#include "core/detect/base/beam_optics.h"
#include "core/detect/base/detect_tile.h"
#include "core/detect/base/effect_parameters.h"
#include "core/detect/base/lane_random.h"
#include "core/detect/base/vector_math.h"

namespace railcast {

struct PulseStretchParameters {
  float pulse_sigma_m{};
  bool lowers_power{};  ///< As StretchLowersPower().
  bool moves_peak{};    ///< Whether beams of one hit lie on its plane: effect `footprint` looks.
};

/// Edge of the cells of effect `texture`.
inline constexpr float kTextureCell_m = 0.03F;

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
    tile.reflectivity[i] += covered * (p.snow_a - tile.reflectivity[i]);  // To the sun.
    const float range_m = tile.true_range_m[i];
    tile.intensity[i] = tile.share[i] * rho;
    tile.power_ratio[i] = tile.share[i] * rho * p.inverse_power_m2 / (range_m * range_m);
  }
}

/// The integer below, also where the instruction set cannot round.
[[nodiscard]] inline std::uint32_t FloorOf(float x) {
  const auto whole = static_cast<std::int32_t>(x);
  return static_cast<std::uint32_t>(whole - (static_cast<float>(whole) > x ? 1 : 0));
}

/// A word for a cell of effect `texture`, cheaper than Philox: the steps of MurmurHash3's last
/// mixing (Appleby), once for each number.
[[nodiscard]] inline std::uint32_t HashOfCell(
    std::uint32_t seed, std::uint32_t x, std::uint32_t y, std::uint32_t z, std::uint32_t instance) {
  std::uint32_t hash = seed;
  for (const std::uint32_t number : {x, y, z, instance}) {
    hash = (hash ^ number) * 0x85EBCA6BU;
    hash ^= hash >> 13U;
    hash *= 0xC2B2AE35U;
    hash ^= hash >> 16U;
  }
  return hash;
}

/// Effect `texture`: the response of a surface varies among cubic cells of the edge a, which are
/// fixed to its own coordinates. Of a cell it has a log-normal factor with mean 1 and the standard
/// deviation sigma of its logarithm, hence the relative variance v = exp(sigma^2) - 1. A beam takes
/// the mean over its footprint, whose relative variance is less:
///
///   factor = exp(g n - g^2 / 2),   g^2 = ln(1 + V v),   n ~ N(0, 1) by the cell of its middle
///   V = 1 / sqrt(1 + 3 sqrt(t) + k t + k^2 d),   k = 4 pi
///   t = (h^2 + w^2 + spread^2) / a^2,   d = h^2 w^2 / (a^4 cos^2)
///
/// V is the probability that two places of the footprint are in one cell, t and d are the trace and
/// the determinant of the footprint's covariance on the surface (h, w: share^(1/2) sigma R across
/// the beam). If places a distance x apart were in one cell with the probability exp(-pi x^2 /
/// a^2), which has the integral over a line of the true one along an edge, 1 - |x| / a, then V
/// would be as here but for 3 sqrt(t), since x is normal with twice that covariance. That term
/// stands for the corner of the true one at x = 0 (ours): with it V is within 8 % of what cells of
/// any direction have (tests).
///
/// Validity: neighbouring beams whose footprints overlap share cells, which only beams with their
/// middles in one cell show here.
inline void ApplyTexture(DetectTile& tile,
                         const TextureLanes& lanes,
                         const TextureParameters& parameters) {
  const TextureParameters p = parameters;  // The copy cannot alias the tile.
  const auto seed = static_cast<std::uint32_t>(p.seed ^ (p.seed >> 32U));
  constexpr float kPerCell_per_m2 = 12.566371F / (kTextureCell_m * kTextureCell_m);
  constexpr float kCorner = 0.84628438F;  // 3 / sqrt(4 pi)
  const float h2_per_m2 = kPerCell_per_m2 * p.sigma_h_rad * p.sigma_h_rad;
  const float w2_per_m2 = kPerCell_per_m2 * p.sigma_v_rad * p.sigma_v_rad;
  for (std::size_t i = 0; i < tile.num_rays; ++i) {
    const float area_m2 = tile.share[i] * tile.true_range_m[i] * tile.true_range_m[i];
    const float h2 = h2_per_m2 * area_m2;
    const float w2 = w2_per_m2 * area_m2;
    const float along2 = kPerCell_per_m2 * tile.spread_m[i] * tile.spread_m[i];
    const float cosine2 = tile.cos_incidence[i] * tile.cos_incidence[i] + 1e-12F;
    const float trace = h2 + w2 + along2;
    const float apart = 1.0F + kCorner * std::sqrt(trace) + trace + h2 * w2 / cosine2;
    const float g2 = Log(1.0F + lanes.variance[i] / std::sqrt(apart));
    const std::uint32_t hash = HashOfCell(seed, lanes.base_x[i] + FloorOf(lanes.x[i]),
                                          lanes.base_y[i] + FloorOf(lanes.y[i]),
                                          lanes.base_z[i] + FloorOf(lanes.z[i]), lanes.instance[i]);
    const float n = LaneNormals({hash, hash << 16U, hash, hash}).a;
    const float any = Exp(std::sqrt(g2) * n - 0.5F * g2);
    const float factor = lanes.variance[i] > 0.0F ? any : 1.0F;
    tile.intensity[i] *= factor;
    tile.power_ratio[i] *= factor;
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
