// See vector_math.h for why this header has no `#pragma once`.
#ifndef RAILCAST_DETECT_FOG_ECHO_H_
#define RAILCAST_DETECT_FOG_ECHO_H_

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "core/detect/detect_tile.h"
#include "core/detect/effect_parameters.h"
#include "core/detect/fog_echo_parameters.h"
#include "core/detect/fog_field.h"
#include "core/detect/lane_random.h"
#include "core/detect/vector_math.h"
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
  /// The gates in which a peak can lie: [first_gate, end_gate).
  std::size_t first_gate, end_gate;
  alignas(64) float power[kFogGates][kFogGroup];      ///< Over the least detectable power.
  alignas(64) float amplitude[kFogGates][kFogGroup];  ///< The same with the receiver's noise.
};

/// The highest local maxima of a group's beams.
struct FogGroupPeaks {
  alignas(64) float highest[2][kFogGroup];
  alignas(64) float range_m[2][kFogGroup];
  alignas(64) float ratio[2][kFogGroup];
};

/// What a tile's beams can have at most, and the draws that decide whether they have it.
struct FogChances {
  float end_m[kTileSize];       ///< FogEnd_m().
  float most_ratio[kTileSize];  ///< The highest power before it.
  float draw[2][kTileSize];     ///< That of detection.h, by peak; of FogDetection::kSmooth alone.
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

/// Whether the receiver may detect an echo of this power: with the draw by which it decides, and no
/// less power than it gets, since a dirty window only weakens echoes. NormalCdf rises but for its
/// error of 4e-7, hence the margin.
inline bool MayDetectFog(const FogEchoParameters& p, float ratio, float draw) {
  constexpr float kMargin = 1e-6F;
  const float excess = p.snr_at_threshold * (ratio - 1.0F);
  return draw < NormalCdf(excess > 9.0F ? 9.0F : excess) + kMargin;
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
    const float end_m = FogEnd_m(tile, i, p.gate_m);
    const std::size_t num_gates = NumFogGates(p, end_m);
    chances.end_m[i] = end_m;
    chances.most_ratio[i] = num_gates > 0 ? most[num_gates - 1][i / kFogPacket] : 0.0F;
  }
  if (p.detection != FogDetection::kSmooth) return;
  for (std::uint32_t e = 0; e < p.num_peaks; ++e) {
    DrawUniforms(tile, {p.seed, RandomUse::kDetection, p.first_echo + e}, chances.draw[e]);
  }
}

/// The beams that may have a detectable echo, in the order of their lanes. Returns their number.
inline std::size_t SelectFogLanes(const FogEchoParameters& p,
                                  std::size_t num_rays,
                                  const FogChances& chances,
                                  std::size_t* lanes) {
  const float least =
      p.detection == FogDetection::kHard && p.least_ratio < 1.0F ? 1.0F : p.least_ratio;
  bool may_detect[kTileSize];
  for (std::size_t i = 0; i < num_rays; ++i) may_detect[i] = chances.most_ratio[i] >= least;
  if (p.detection == FogDetection::kSmooth) {
    for (std::size_t i = 0; i < num_rays; ++i) {
      // With the lower draw of two, either peak may be detected.
      const float second = p.num_peaks > 1 ? chances.draw[1][i] : 1.0F;
      const float draw = chances.draw[0][i] < second ? chances.draw[0][i] : second;
      may_detect[i] = may_detect[i] & MayDetectFog(p, chances.most_ratio[i], draw);
    }
  }
  std::size_t num = 0;
  for (std::size_t i = 0; i < num_rays; ++i) {
    lanes[num] = i;
    num += may_detect[i] ? 1 : 0;
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
  for (std::size_t k = 0; k < (num_gates + 8) / 8 * 8; ++k) {
    float* const power = group.power[k];
    const float* const row = field[k < p.num_gates ? k : 0];  // What is beyond is not read.
    bool is_enough = false;
    if (are_two) {
      const float of_first = row[first];
      const float of_last = row[last];
      for (std::size_t i = 0; i < kFogGroup; ++i) power[i] = is_last[i] > 0.0F ? of_last : of_first;
      is_enough = of_first >= p.least_ratio || of_last >= p.least_ratio;
    } else {
      for (std::size_t i = 0; i < kFogGroup; ++i) {
        power[i] = row[packet[i]];
        is_enough = is_enough | (power[i] >= p.least_ratio);
      }
    }
    if (k >= num_gates || !is_enough) continue;
    if (group.end_gate == 0) group.first_gate = k;
    group.end_gate = k + 1;
  }
}

/// Adds the receiver's noise in the gates of a group and their neighbours.
inline void FillFogAmplitude(const LaneKey& key, float noise, FogGroup& group) {
  const std::size_t before_first = group.first_gate > 0 ? group.first_gate - 1 : 0;
  for (std::size_t block = before_first / 8; block <= group.end_gate / 8; ++block) {
    const float(*const power)[kFogGroup] = group.power + 8 * block;
    float(*const gates)[kFogGroup] = group.amplitude + 8 * block;
    for (std::size_t i = 0; i < kFogGroup; ++i) {
      const Words w = LaneWords(key, group.firing[i], static_cast<std::uint32_t>(block));
      const FogNoise n0 = FogNoiseOf(w.a);
      const FogNoise n1 = FogNoiseOf(w.b);
      const FogNoise n2 = FogNoiseOf(w.c);
      const FogNoise n3 = FogNoiseOf(w.d);
      gates[0][i] = noise * n0.a + power[0][i];
      gates[1][i] = noise * n0.b + power[1][i];
      gates[2][i] = noise * n1.a + power[2][i];
      gates[3][i] = noise * n1.b + power[3][i];
      gates[4][i] = noise * n2.a + power[4][i];
      gates[5][i] = noise * n2.b + power[5][i];
      gates[6][i] = noise * n3.a + power[6][i];
      gates[7][i] = noise * n3.b + power[7][i];
    }
  }
}

/// The highest local maximum of the amplitude, or the two highest.
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
      const float r = (gate + 0.5F * (b - n) / (b - 2.0F * a + n)) * p.gate_m;
      // Bitwise operators, unlike branches, allow the loop to be vectorised.
      const bool is_peak = (a > b) & (a >= n) & (value >= p.least_ratio) & (r < group.end_m[i]) &
                           (r >= p.range_min_m);
      // Reading all before writing any lets the compiler use plain stores instead of masked ones.
      const float a0 = peaks.highest[0][i];
      const float r0 = peaks.range_m[0][i];
      const float v0 = peaks.ratio[0][i];
      const bool is_first = is_peak & (a > a0);
      if constexpr (kNumPeaks > 1) {
        const float a1 = peaks.highest[1][i];
        const float r1 = peaks.range_m[1][i];
        const float v1 = peaks.ratio[1][i];
        const bool is_second = is_peak & (a > a1);
        const float second_a = is_second ? a : a1;
        const float second_r = is_second ? r : r1;
        const float second_v = is_second ? value : v1;
        peaks.highest[1][i] = is_first ? a0 : second_a;
        peaks.range_m[1][i] = is_first ? r0 : second_r;
        peaks.ratio[1][i] = is_first ? v0 : second_v;
      }
      peaks.highest[0][i] = is_first ? a : a0;
      peaks.range_m[0][i] = is_first ? r : r0;
      peaks.ratio[0][i] = is_first ? value : v0;
    }
  }
}

/// Stores a group's peaks, but for those that the receiver will not detect.
inline void StoreFogPeaks(const FogEchoParameters& p,
                          const FogGroup& group,
                          const FogChances& chances,
                          const FogGroupPeaks& found,
                          FogPeaks& peaks) {
  for (std::size_t e = 0; e < p.num_peaks; ++e) {
    for (std::size_t i = 0; i < group.num_lanes; ++i) {
      const std::size_t lane = group.lane[i];
      const float ratio = found.ratio[e][i];
      const bool may_detect = p.detection == FogDetection::kAlways ? true
                              : p.detection == FogDetection::kHard
                                  ? ratio >= 1.0F
                                  : MayDetectFog(p, ratio, chances.draw[e][lane]);
      peaks.range_m[e][lane] = found.range_m[e][i];
      peaks.ratio[e][lane] = may_detect ? ratio : 0.0F;
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
/// draws anew whether it detects them (effect `detection_probability`). Echoes that this draw will
/// not let through are left out at once, and so are beams that can have no other.
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
    FillFogAmplitude(key, p.noise, group);
    if (p.num_peaks > 1) {
      PickFogPeaks<2>(p, group, found);
    } else {
      PickFogPeaks<1>(p, group, found);
    }
    StoreFogPeaks(p, group, chances, found, peaks);
  }
}

}  // namespace railcast::RAILCAST_ISA

#endif  // RAILCAST_DETECT_FOG_ECHO_H_
