// See vector_math.h for why this header has no `#pragma once`.
#ifndef RAILCAST_DETECT_FOG_FIELD_H_
#define RAILCAST_DETECT_FOG_FIELD_H_

#include <cstddef>

#include "core/detect/base/detect_tile.h"
#include "core/detect/base/effect_parameters.h"
#include "core/detect/base/vector_math.h"

namespace railcast {

struct FogEchoParameters {
  std::uint64_t seed{};
  std::uint32_t first_gate{};  ///< FogProfile::first_gate.
  std::uint32_t num_gates{};   ///< At most kMostFogGates; the last is only compared with.
  float gate_m{};
  const float* mean_ratio{};  ///< By gate: FogProfile::ratio.
  float least_ratio{};        ///< Gates with less power have no peak.
  /// Weights of a gate's own draw and of those of its neighbours in its noise: FogNoiseOf().
  float noise_own{}, noise_beside{};
  float variation{};  ///< Standard deviation of the logarithm of the density.
  float range_min_m{};
  float merge_m{};  ///< Echoes of fog that are nearer to a surface or to another merge with it.
  std::size_t num_peaks = 2;  ///< 1 where only the highest is looked for.
  float threshold{};          ///< Lower peaks are not detected.
  bool is_behind_cover{};     ///< Whether DetectTile::cover weakens the fog's power.
};

}  // namespace railcast

namespace railcast::RAILCAST_ISA {

inline constexpr std::size_t kFogGates = 128;

/// Neighbouring lanes that meet the same patches: those of a packet, which are neighbours in angle.
inline constexpr std::size_t kFogPacket = 16;
inline constexpr std::size_t kFogPackets = kTileSize / kFogPacket;
/// The logarithm of the density by gate and packet, in standard deviations; then the power over the
/// least detectable.
using FogField = float[kFogGates][kFogPackets];

/// The field of FogPatches along the middle beam of every packet. The phase of a wave is linear in
/// range, so that one rotation leads from gate to gate.
inline void FillFogField(const FogBeams& beams, const FogEchoParameters& p, FogField& field) {
  const RayTile& rays = beams.rays;
  const FogWaves& waves = beams.waves;
  for (std::size_t k = 0; k < p.num_gates; ++k) {
    for (std::size_t i = 0; i < kFogPackets; ++i) field[k][i] = 0.0F;
  }
  alignas(64) float x[kFogPackets], y[kFogPackets], z[kFogPackets];
  alignas(64) float start_x[kFogPackets], start_y[kFogPackets], start_z[kFogPackets];
  const float first_m = (static_cast<float>(p.first_gate) + 0.5F) * p.gate_m;
  for (std::size_t i = 0; i < kFogPackets; ++i) {
    // The last tile of a frame may have fewer packets; what its last ray meets is harmless there.
    const std::size_t middle = i * kFogPacket + kFogPacket / 2;
    const std::size_t ray = middle < rays.num_rays ? middle : rays.num_rays - 1;
    x[i] = rays.direction_x[ray];
    y[i] = rays.direction_y[ray];
    z[i] = rays.direction_z[ray];
    start_x[i] = rays.origin_x[ray] + first_m * x[i];
    start_y[i] = rays.origin_y[ray] + first_m * y[i];
    start_z[i] = rays.origin_z[ray] + first_m * z[i];
  }
  for (std::size_t w = 0; w < kNumFogWaves; ++w) {
    const float kx = waves.x[w];
    const float ky = waves.y[w];
    const float kz = waves.z[w];
    const float phase = waves.phase[w];
    const float amplitude = waves.amplitude[w];
    alignas(64) float c[kFogPackets], s[kFogPackets];
    alignas(64) float step_c[kFogPackets], step_s[kFogPackets];
    for (std::size_t i = 0; i < kFogPackets; ++i) {
      const float step = p.gate_m * (kx * x[i] + ky * y[i] + kz * z[i]);
      const float start = kx * start_x[i] + ky * start_y[i] + kz * start_z[i] + phase;
      CosSinTurn(WithinHalfATurn(start), c[i], s[i]);
      CosSinTurn(WithinHalfATurn(step), step_c[i], step_s[i]);
      c[i] *= amplitude;
      s[i] *= amplitude;
    }
    for (std::size_t k = 0; k < p.num_gates; ++k) {
      for (std::size_t i = 0; i < kFogPackets; ++i) {
        field[k][i] += c[i];
        const float next = c[i] * step_c[i] - s[i] * step_s[i];
        s[i] = s[i] * step_c[i] + c[i] * step_s[i];
        c[i] = next;
      }
    }
  }
}

/// Turns the logarithm of the density into the power over the threshold.
inline void TurnIntoPower(const FogEchoParameters& p, FogField& field) {
  const float bias = -0.5F * p.variation * p.variation;
  for (std::size_t k = 0; k < p.num_gates; ++k) {
    const float mean = p.mean_ratio[k];
    for (std::size_t i = 0; i < kFogPackets; ++i) {
      field[k][i] = mean * Exp(p.variation * field[k][i] + bias);
    }
  }
}

}  // namespace railcast::RAILCAST_ISA

#endif  // RAILCAST_DETECT_FOG_FIELD_H_
