#pragma once

#include <cstdint>

namespace railcast {

/// The effects' parameters as their kernels want them: float32, derived once from the specs.
struct ThresholdParameters {
  float inverse_threshold_m2{};  ///< reference_range^2 / reference_threshold
  float fog_density_per_m{};
};

struct RainParameters {
  std::uint64_t seed{};
  float dropout_per_m{};  ///< k * RR^e
};

struct SnowParameters {
  std::uint64_t seed{};
  float probability{};  ///< That a flake answers.
  float range_scale_m{};
  float range_min_m{};
  float intensity{};     ///< NaN without the threshold: then no power is computed ...
  bool has_threshold{};  ///< ... and no flake is too weak.
  ThresholdParameters threshold;
};

struct SensorDropoutParameters {
  std::uint64_t seed{};
  float probability{};
};

enum class NoiseShape { kNone, kIsotropic, kBeam };

struct MeasurementParameters {
  std::uint64_t seed{};
  float sigma0_m{};
  float sigma1{};
  float range_min_m{};
  float range_max_m{};
};

}  // namespace railcast
