#pragma once

#include <cstddef>
#include <cstdint>

namespace railcast {

/// What decides whether an echo of fog is detected.
enum class FogDetection {
  kAlways,  ///< Nothing: effect `detection` is off.
  kHard,    ///< Its power.
  kSmooth,  ///< Its power and a draw: effect `detection_probability`.
};

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
  std::size_t num_peaks = 2;  ///< 1 where only the highest is looked for.
  FogDetection detection = FogDetection::kAlways;
  float snr_at_threshold{};
  std::uint32_t first_echo{};  ///< Number of the highest peak's echo, part of its random key.
};

}  // namespace railcast
