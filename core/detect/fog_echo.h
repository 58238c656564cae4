// See vector_math.h for why this header has no `#pragma once`.
#ifndef RAILCAST_DETECT_FOG_ECHO_H_
#define RAILCAST_DETECT_FOG_ECHO_H_

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "core/detect/detect_tile.h"
#include "core/detect/effect_parameters.h"
#include "core/detect/lane_random.h"
#include "core/detect/vector_math.h"
#include "railcast/outcome.h"

namespace railcast {

struct FogEchoParameters {
  std::uint64_t seed{};
  std::uint32_t first_gate{};  ///< FogProfile::first_gate.
  std::uint32_t num_gates{};   ///< At most kMostFogGates; the last is only compared with.
  float gate_m{};
  const float* mean_ratio{};  ///< By gate: FogProfile::ratio.
  float least_ratio{};        ///< Weaker echoes are left out.
  float noise{};      ///< Standard deviation of the amplitude over the threshold, 1 / SNR_t.
  float variation{};  ///< Standard deviation of the logarithm of the density.
  float range_min_m{};
};

}  // namespace railcast

namespace railcast::RAILCAST_ISA {

/// Lanes that are processed together, so that their gates stay in the fastest cache.
inline constexpr std::size_t kFogLanes = 64;
inline constexpr std::size_t kFogGates = 64;

/// Values of one strip of lanes by gate.
using FogStrip = float[kFogGates][kFogLanes];

/// Neighbouring lanes that meet the same patches: those of a packet, which are neighbours in angle.
inline constexpr std::size_t kFogPacket = 16;
inline constexpr std::size_t kFogPackets = kTileSize / kFogPacket;
/// The logarithm of the density by gate and packet, in standard deviations.
using FogField = float[kFogGates][kFogPackets];

/// The gates of a strip.
struct FogSignal {
  FogStrip power;          ///< Over the least detectable power.
  FogStrip amplitude;      ///< Power with the receiver's noise.
  float end_m[kFogLanes];  ///< FogEnd_m().
};

/// Part of a tile: `num` lanes from lane `begin` on, and the gates that they need.
struct FogPart {
  std::size_t begin, num, num_gates;
};

/// Range from which on nothing of the fog is seen separately: a gate before the first surface, with
/// whose echo it merges. 0 where the beam does not leave the vehicle, 1e9 m without a surface.
inline float FogEnd_m(const DetectTile& tile, std::size_t lane, float gate_m) {
  const float range_m = tile.true_range_m[lane];
  const bool is_ego = tile.outcome[lane] == static_cast<std::uint32_t>(Outcome::kEgo);
  const float end_m = range_m - gate_m;
  // The comparison is false where there is no surface: its range is NaN.
  return is_ego ? 0.0F : range_m >= 0.0F ? end_m : 1e9F;
}

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
      // Adding and subtracting 1.5 * 2^23 rounds to whole turns; the rest is in [-1/2, 1/2].
      constexpr float kRounder = 12582912.0F;
      CosSinTurn(start - ((start + kRounder) - kRounder), c[i], s[i]);
      CosSinTurn(step - ((step + kRounder) - kRounder), step_c[i], step_s[i]);
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

struct FogNoise {
  float a, b;
};

/// Two deviates of mean 0 and variance 1 from one word: sums of four of its digits to base 16. They
/// are normal but for their tails (kurtosis 2.7, at most 3.25), which suffices to say where a broad
/// peak is found, and costs a third of true ones.
inline FogNoise FogNoiseOf(std::uint32_t word) {
  const std::uint32_t pairs = (word & 0x0F0F0F0FU) + ((word >> 4U) & 0x0F0F0F0FU);
  const std::uint32_t fours = (pairs & 0x00FF00FFU) + ((pairs >> 8U) & 0x00FF00FFU);
  constexpr float kMean = 30.0F;
  constexpr float kInverseSigma = 0.10846523F;  // The variance of a digit is (16^2 - 1) / 12.
  return {(static_cast<float>(static_cast<std::int32_t>(fours & 0xFFFFU)) - kMean) * kInverseSigma,
          (static_cast<float>(static_cast<std::int32_t>(fours >> 16U)) - kMean) * kInverseSigma};
}

/// Spreads the packets' power over their lanes, and adds the receiver's noise.
inline void FillFogGates(const DetectTile& tile,
                         const FogPart& part,
                         const FogEchoParameters& p,
                         const FogField& field,
                         FogSignal& signal) {
  const LaneKey key{p.seed, RandomUse::kFogEcho, tile.frame};
  for (std::size_t k = 0; k < part.num_gates; ++k) {
    for (std::size_t packet = 0; packet < kFogLanes / kFogPacket; ++packet) {
      const float value = field[k][part.begin / kFogPacket + packet];
      for (std::size_t i = 0; i < kFogPacket; ++i) {
        signal.power[k][packet * kFogPacket + i] = value;
      }
    }
  }
  for (std::size_t k = 0; k < part.num_gates; k += 8) {
    const auto block = static_cast<std::uint32_t>(k / 8);
    // The arrays hold a multiple of 8 gates, of which those beyond the last are not used.
    for (std::size_t i = 0; i < part.num; ++i) {
      const Words w = LaneWords(key, tile.firing[part.begin + i], block);
      const FogNoise n0 = FogNoiseOf(w.a);
      const FogNoise n1 = FogNoiseOf(w.b);
      const FogNoise n2 = FogNoiseOf(w.c);
      const FogNoise n3 = FogNoiseOf(w.d);
      signal.amplitude[k][i] = p.noise * n0.a;
      signal.amplitude[k + 1][i] = p.noise * n0.b;
      signal.amplitude[k + 2][i] = p.noise * n1.a;
      signal.amplitude[k + 3][i] = p.noise * n1.b;
      signal.amplitude[k + 4][i] = p.noise * n2.a;
      signal.amplitude[k + 5][i] = p.noise * n2.b;
      signal.amplitude[k + 6][i] = p.noise * n3.a;
      signal.amplitude[k + 7][i] = p.noise * n3.b;
    }
  }
  for (std::size_t k = 0; k < part.num_gates; ++k) {
    for (std::size_t i = 0; i < part.num; ++i) signal.amplitude[k][i] += signal.power[k][i];
  }
}

/// The two highest local maxima of the amplitude.
inline void PickFogPeaks(const FogPart& part,
                         const FogEchoParameters& p,
                         const FogSignal& signal,
                         FogPeaks& peaks) {
  alignas(64) float highest[2][kFogLanes] = {};
  alignas(64) float range_m[2][kFogLanes] = {};
  alignas(64) float ratio[2][kFogLanes] = {};
  alignas(64) const float zero[kFogLanes] = {};
  for (std::size_t k = 0; k + 1 < part.num_gates; ++k) {
    const float* const before = k == 0 ? zero : signal.amplitude[k - 1];
    const float* const here = signal.amplitude[k];
    const float* const after = signal.amplitude[k + 1];
    const float* const value = signal.power[k];
    const float* const end_m = signal.end_m;
    const float gate = static_cast<float>(p.first_gate + k) + 0.5F;
    for (std::size_t i = 0; i < part.num; ++i) {
      const float b = before[i];
      const float a = here[i];
      const float n = after[i];
      const float v = value[i];
      // The vertex of the parabola through three gates.
      const float r = (gate + 0.5F * (b - n) / (b - 2.0F * a + n)) * p.gate_m;
      // Bitwise operators, unlike branches, allow the loop to be vectorised.
      const bool is_peak =
          (a > b) & (a >= n) & (v >= p.least_ratio) & (r < end_m[i]) & (r >= p.range_min_m);
      // Reading all before writing any lets the compiler use plain stores instead of masked ones.
      const float a0 = highest[0][i];
      const float a1 = highest[1][i];
      const float r0 = range_m[0][i];
      const float r1 = range_m[1][i];
      const float v0 = ratio[0][i];
      const float v1 = ratio[1][i];
      const bool is_first = is_peak & (a > a0);
      const bool is_second = is_peak & (a > a1);
      const float second_a = is_second ? a : a1;
      const float second_r = is_second ? r : r1;
      const float second_v = is_second ? v : v1;
      highest[1][i] = is_first ? a0 : second_a;
      range_m[1][i] = is_first ? r0 : second_r;
      ratio[1][i] = is_first ? v0 : second_v;
      highest[0][i] = is_first ? a : a0;
      range_m[0][i] = is_first ? r : r0;
      ratio[0][i] = is_first ? v : v0;
    }
  }
  for (std::size_t e = 0; e < 2; ++e) {
    for (std::size_t i = 0; i < part.num; ++i) {
      peaks.range_m[e][part.begin + i] = range_m[e][i];
      peaks.ratio[e][part.begin + i] = ratio[e][i];
    }
  }
}

/// Effect `fog_echo`: the power that the droplets return is sampled in gates a pulse length apart,
///
///   power(k) = mean ratio(k) * density(place of gate k),   amplitude(k) = power(k) + n / SNR_t
///
/// with the mean ratio of FogProfile and the density of FogPatches, taken where the middle beam of
/// a packet of 16 neighbours is. A receiver that looks for the highest peak finds it where the
/// amplitude with its noise is highest, so that the ranges scatter over the whole of the fog's
/// broad echo. The two highest local maxima before the first surface become echoes, at the vertex
/// of the parabola through three gates. Their power without noise goes on to the receiver, which
/// draws anew whether it detects them (effect `detection_probability`).
///
/// Parameters: visibility or fog density and `fog_variation` of the weather, `near_range_m`,
/// `fog_gain` and `snr_at_threshold` of the receiver, the pulse. Validity: single scattering;
/// extinction on the way is that of the mean density. Sources: docs/physics.md 4.3.
inline void FindFogPeaks(const FogBeams& beams,
                         const FogEchoParameters& parameters,
                         FogPeaks& peaks) {
  const DetectTile& tile = beams.tile;
  const FogEchoParameters p = parameters;  // The copy cannot alias the tile.
  alignas(64) FogField field;
  alignas(64) FogSignal signal;
  FillFogField(beams, p, field);
  TurnIntoPower(p, field);
  for (std::size_t begin = 0; begin < tile.num_rays; begin += kFogLanes) {
    const std::size_t rest = tile.num_rays - begin;
    FogPart part{begin, rest < kFogLanes ? rest : kFogLanes, 0};
    float farthest_m = 0.0F;
    for (std::size_t i = 0; i < part.num; ++i) {
      signal.end_m[i] = FogEnd_m(tile, begin + i, p.gate_m);
      farthest_m = signal.end_m[i] > farthest_m ? signal.end_m[i] : farthest_m;
    }
    // Gates behind the farthest surface of the strip are not needed, but for one to compare with.
    const float gates = farthest_m / p.gate_m + 2.0F - static_cast<float>(p.first_gate);
    part.num_gates = gates >= static_cast<float>(p.num_gates) ? p.num_gates
                     : gates > 0.0F                           ? static_cast<std::size_t>(gates)
                                                              : 0;
    FillFogGates(tile, part, p, field, signal);
    PickFogPeaks(part, p, signal, peaks);
  }
}

}  // namespace railcast::RAILCAST_ISA

#endif  // RAILCAST_DETECT_FOG_ECHO_H_
