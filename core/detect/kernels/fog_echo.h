// See vector_math.h for why this header has no `#pragma once`.
#ifndef RAILCAST_DETECT_FOG_ECHO_H_
#define RAILCAST_DETECT_FOG_ECHO_H_

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "core/detect/base/detect_tile.h"
#include "core/detect/base/effect_parameters.h"
#include "core/detect/base/lane_random.h"
#include "core/detect/base/vector_math.h"
#include "core/detect/kernels/fog_field.h"
#include "railcast/outcome.h"

namespace railcast::RAILCAST_ISA {

/// Beams that are processed together.
inline constexpr std::size_t kFogGroup = 16;

/// Beams that may have a detectable echo of fog, and the power that the droplets return to them.
struct FogGroup {
  std::size_t lane[kFogGroup];  ///< In the tile; those beyond num_lanes repeat the last.
  std::size_t num_lanes;
  std::uint32_t firing[kFogGroup];
  float end_m[kFogGroup];  ///< FogEnd_m().
  float cover[kFogGroup];  ///< Share of the power that the window lets through.
  /// The gates in which a peak can lie: [first_gate, end_gate).
  std::size_t first_gate, end_gate;
  alignas(64) float power[kFogGates][kFogGroup];      ///< Over the least detectable power.
  alignas(64) float draw[kFogGates + 8][kFogGroup];   ///< The draw of gate k is at k + 1.
  alignas(64) float amplitude[kFogGates][kFogGroup];  ///< The power with the receiver's noise.
};

/// The highest local maxima of the amplitude of a group's beams; 0 where there is none.
struct FogGroupPeaks {
  alignas(64) float amplitude[2][kFogGroup];
  alignas(64) float range_m[2][kFogGroup];
};

/// What a tile's beams can have at most.
struct FogChances {
  float end_m[kTileSize];       ///< FogEnd_m().
  float most_ratio[kTileSize];  ///< The highest power before it.
};

/// Range from which on nothing of the fog is seen separately: `merge_m` before the first surface,
/// with whose echo it merges. 0 where the beam does not leave the vehicle, 1e9 m without a surface.
inline float FogEnd_m(const DetectTile& tile, std::size_t lane, float merge_m) {
  const float range_m = tile.true_range_m[lane];
  const bool is_ego = tile.outcome[lane] == static_cast<std::uint32_t>(Outcome::kEgo);
  const float end_m = range_m - merge_m;
  // The comparison is false where there is no surface: its range is NaN.
  return is_ego ? 0.0F : range_m >= 0.0F ? end_m : 1e9F;
}

struct FogDraws {
  float a, b;
};

/// Two standard normal deviates from one word (Box and Muller 1958). The uniform under the
/// logarithm has 16 bits, so that no deviate is larger than 4.86.
inline FogDraws FogDrawsOf(std::uint32_t word) {
  const auto upper = static_cast<float>(static_cast<std::int32_t>(word >> 16U));
  const auto lower = static_cast<float>(static_cast<std::int32_t>(word & 0xFFFFU));
  const float size = std::sqrt(-2.0F * Log((upper + 0.5F) * 0x1p-16F));
  float cosine{};
  float sine{};
  CosSinTurn(lower * 0x1p-16F, cosine, sine);
  return {size * cosine, size * sine};
}

/// The number of gates in which a beam can have a peak that lies before end_m.
inline std::size_t NumFogGates(const FogEchoParameters& p, float end_m) {
  // A vertex is at most half a gate from the middle of its own.
  const float gates = end_m / p.gate_m + 1.0F - static_cast<float>(p.first_gate);
  // The last gate is only compared with.
  const std::size_t most = p.num_gates - 1;
  return gates >= static_cast<float>(most) ? most
         : gates > 0.0F                    ? static_cast<std::size_t>(gates) + 1
                                           : 0;
}

inline void FindFogChances(const DetectTile& tile,
                           const FogEchoParameters& p,
                           const FogField& field,
                           FogChances& chances) {
  FogField most;  // In this gate or nearer.
  for (std::size_t i = 0; i < kFogPackets; ++i) most[0][i] = field[0][i];
  for (std::size_t k = 1; k < p.num_gates; ++k) {
    for (std::size_t i = 0; i < kFogPackets; ++i) {
      most[k][i] = field[k][i] > most[k - 1][i] ? field[k][i] : most[k - 1][i];
    }
  }
  for (std::size_t i = 0; i < tile.num_rays; ++i) {
    const float end_m = FogEnd_m(tile, i, p.merge_m);
    const std::size_t num_gates = NumFogGates(p, end_m);
    chances.end_m[i] = end_m;
    chances.most_ratio[i] = num_gates > 0 ? most[num_gates - 1][i / kFogPacket] : 0.0F;
  }
}

/// The beams that may have a detectable echo, in the order of their lanes. Returns their number.
inline std::size_t SelectFogLanes(const FogEchoParameters& p,
                                  std::size_t num_rays,
                                  const FogChances& chances,
                                  std::size_t* lanes) {
  std::size_t num = 0;
  for (std::size_t i = 0; i < num_rays; ++i) {
    lanes[num] = i;
    num += chances.most_ratio[i] >= p.least_ratio ? 1 : 0;
  }
  return num;
}

/// Gathers beams, and the gates in which they can have a peak: those where the power is enough, up
/// to the farthest surface.
inline void GatherFogGroup(const DetectTile& tile,
                           const FogEchoParameters& p,
                           const FogField& field,
                           const FogChances& chances,
                           FogGroup& group) {
  float farthest_m = 0.0F;
  std::size_t packet[kFogGroup];
  for (std::size_t i = 0; i < kFogGroup; ++i) {
    const std::size_t lane = group.lane[i];
    packet[i] = lane / kFogPacket;
    group.firing[i] = tile.firing[lane];
    group.end_m[i] = chances.end_m[lane];
    group.cover[i] = p.is_behind_cover ? tile.cover[lane] : 1.0F;
    farthest_m = group.end_m[i] > farthest_m ? group.end_m[i] : farthest_m;
  }
  // Neighbouring beams are of one packet or of two. The selection between two rows is vectorised,
  // a look-up for each beam is not.
  const std::size_t first = packet[0];
  const std::size_t last = packet[kFogGroup - 1];
  float is_last[kFogGroup];  // 0 or 1.
  bool are_two = true;
  for (std::size_t i = 0; i < kFogGroup; ++i) {
    is_last[i] = packet[i] == last ? 1.0F : 0.0F;
    are_two = are_two & ((packet[i] == first) | (packet[i] == last));
  }
  group.first_gate = group.end_gate = 0;
  const std::size_t num_gates = NumFogGates(p, farthest_m);
  for (std::size_t k = 0; k <= num_gates; ++k) {
    float* const power = group.power[k];
    const float* const row = field[k];
    bool is_enough = false;
    if (are_two) {
      const float of_first = row[first];
      const float of_last = row[last];
      for (std::size_t i = 0; i < kFogGroup; ++i) {
        power[i] = (is_last[i] > 0.0F ? of_last : of_first) * group.cover[i];
      }
      is_enough = of_first >= p.least_ratio || of_last >= p.least_ratio;
    } else {
      for (std::size_t i = 0; i < kFogGroup; ++i) {
        power[i] = row[packet[i]] * group.cover[i];
        is_enough = is_enough | (power[i] >= p.least_ratio);
      }
    }
    if (k >= num_gates || !is_enough) continue;
    if (group.end_gate == 0) group.first_gate = k;
    group.end_gate = k + 1;
  }
}

/// Draws for the gates of a group and those beside them.
inline void DrawFogNoise(const LaneKey& key, FogGroup& group) {
  const std::size_t first = group.first_gate > 0 ? group.first_gate - 1 : 0;
  for (std::size_t block = first / 8; block <= (group.end_gate + 2) / 8; ++block) {
    float(*const draws)[kFogGroup] = group.draw + 8 * block;
    for (std::size_t i = 0; i < kFogGroup; ++i) {
      const Words w = LaneWords(key, group.firing[i], static_cast<std::uint32_t>(block));
      const FogDraws n0 = FogDrawsOf(w.a);
      const FogDraws n1 = FogDrawsOf(w.b);
      const FogDraws n2 = FogDrawsOf(w.c);
      const FogDraws n3 = FogDrawsOf(w.d);
      draws[0][i] = n0.a;
      draws[1][i] = n0.b;
      draws[2][i] = n1.a;
      draws[3][i] = n1.b;
      draws[4][i] = n2.a;
      draws[5][i] = n2.b;
      draws[6][i] = n3.a;
      draws[7][i] = n3.b;
    }
  }
}

/// Adds the receiver's noise to the power in the gates of a group and their neighbours.
inline void FillFogAmplitude(const FogEchoParameters& p, FogGroup& group) {
  const float own = p.noise_own;
  const float beside = p.noise_beside;
  const std::size_t first = group.first_gate > 0 ? group.first_gate - 1 : 0;
  for (std::size_t k = first; k <= group.end_gate; ++k) {
    const float* const power = group.power[k];
    const float* const before = group.draw[k];
    const float* const here = group.draw[k + 1];
    const float* const after = group.draw[k + 2];
    float* const amplitude = group.amplitude[k];
    for (std::size_t i = 0; i < kFogGroup; ++i) {
      amplitude[i] = power[i] + (own * here[i] + beside * (before[i] + after[i]));
    }
  }
}

/// The highest local maximum of the amplitude, or the two highest that are a pulse apart, as far as
/// they are detected.
template <std::size_t kNumPeaks>
inline void PickFogPeaks(const FogEchoParameters& p, const FogGroup& group, FogGroupPeaks& peaks) {
  alignas(64) const float zero[kFogGroup] = {};
  for (std::size_t k = group.first_gate; k < group.end_gate; ++k) {
    const float* const power = group.power[k];
    const float* const before = k == 0 ? zero : group.amplitude[k - 1];
    const float* const here = group.amplitude[k];
    const float* const after = group.amplitude[k + 1];
    const float gate = static_cast<float>(p.first_gate + k) + 0.5F;
    for (std::size_t i = 0; i < kFogGroup; ++i) {
      const float value = power[i];
      const float b = before[i];
      const float a = here[i];
      const float n = after[i];
      // The vertex of the parabola through three gates.
      const float offset = 0.5F * (b - n) / (b - 2.0F * a + n);
      const float r = (gate + offset) * p.gate_m;
      const float top = a - 0.25F * (b - n) * offset;
      // Bitwise operators, unlike branches, allow the loop to be vectorised.
      const bool is_peak = (a > b) & (a >= n) & (value >= p.least_ratio) & (r < group.end_m[i]) &
                           (r >= p.range_min_m) & (top >= p.threshold);
      // Reading all before writing any lets the compiler use plain stores instead of masked ones.
      const float a0 = peaks.amplitude[0][i];
      const float r0 = peaks.range_m[0][i];
      const bool is_first = is_peak & (top > a0);
      if constexpr (kNumPeaks > 1) {
        // If two peaks are nearer to each other than a pulse, only the higher one is seen. All
        // peaks so far are nearer to the sensor than this one.
        const float a1 = peaks.amplitude[1][i];
        const float r1 = peaks.range_m[1][i];
        const bool is_apart = r - r0 >= p.merge_m;
        const bool is_second = is_peak & is_apart & (top > a1);
        const float lower_a = is_first ? a0 : top;
        const float lower_r = is_first ? r0 : r;
        peaks.amplitude[1][i] = is_second ? lower_a : a1;
        peaks.range_m[1][i] = is_second ? lower_r : r1;
      }
      peaks.amplitude[0][i] = is_first ? top : a0;
      peaks.range_m[0][i] = is_first ? r : r0;
    }
  }
}

/// Stores a group's peaks.
inline void StoreFogPeaks(const FogEchoParameters& p,
                          const FogGroup& group,
                          const FogGroupPeaks& found,
                          FogPeaks& peaks) {
  for (std::size_t e = 0; e < p.num_peaks; ++e) {
    for (std::size_t i = 0; i < group.num_lanes; ++i) {
      peaks.range_m[e][group.lane[i]] = found.range_m[e][i];
      peaks.ratio[e][group.lane[i]] = found.amplitude[e][i];
    }
  }
}

/// Effect `fog_echo`: the power that the droplets return is sampled in gates half a pulse length
/// apart,
///
///   power(k) = mean ratio(k) * density(place of gate k),   amplitude(k) = power(k) + n(k) / SNR_t
///
/// with the mean ratio of FogProfile and the density of FogPatches, taken where the middle beam of
/// a packet of 16 neighbours is. n is the receiver's noise, as long in range as its pulse
/// (FogNoiseOf()). One noise decides both whether the fog is detected and where: the highest local
/// maxima of the amplitude that reach the threshold, a pulse apart, become echoes, at the vertex of
/// the parabola through three gates and with its height as their power. The ranges therefore
/// scatter over the whole of the fog's broad echo, and the many places at which noise may lift it
/// above the threshold make fog visible whose power alone would not be. Effect `detection` passes
/// these echoes on as they are. Where `detection_probability` is off, the receiver has no noise;
/// where `detection` is, no threshold.
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
  FogChances chances;
  FogGroup group;
  std::size_t lanes[kTileSize];
  FillFogField(beams, p, field);
  TurnIntoPower(p, field);
  for (std::size_t e = 0; e < 2; ++e) {
    for (std::size_t i = 0; i < tile.num_rays; ++i) peaks.ratio[e][i] = 0.0F;
  }
  FindFogChances(tile, p, field, chances);
  const std::size_t num_lanes = SelectFogLanes(p, tile.num_rays, chances, lanes);
  const LaneKey key{p.seed, RandomUse::kFogEcho, tile.frame};
  for (std::size_t begin = 0; begin < num_lanes; begin += kFogGroup) {
    const std::size_t rest = num_lanes - begin;
    group.num_lanes = rest < kFogGroup ? rest : kFogGroup;
    for (std::size_t i = 0; i < kFogGroup; ++i) {
      group.lane[i] = lanes[begin + (i < group.num_lanes ? i : group.num_lanes - 1)];
    }
    GatherFogGroup(tile, p, field, chances, group);
    if (group.end_gate == 0) continue;
    FogGroupPeaks found{};
    DrawFogNoise(key, group);
    FillFogAmplitude(p, group);
    if (p.num_peaks > 1) {
      PickFogPeaks<2>(p, group, found);
    } else {
      PickFogPeaks<1>(p, group, found);
    }
    StoreFogPeaks(p, group, found, peaks);
  }
}

}  // namespace railcast::RAILCAST_ISA

#endif  // RAILCAST_DETECT_FOG_ECHO_H_
