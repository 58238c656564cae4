#pragma once

#include <cstddef>
#include <cstdint>

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
