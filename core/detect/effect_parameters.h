#pragma once

#include <cstdint>

#include "core/base/random.h"

namespace railcast {

// The effects' parameters as their kernels want them: float32, derived once from the specs.

/// What draws of a tile's firings have in common.
struct DrawKey {
  std::uint64_t seed{};
  RandomUse use{};
  std::uint32_t block{};
};

// The published model.

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
  float intensity{};      ///< NaN without the threshold: then no power is computed ...
  bool has_threshold{};   ///< ... and no flake is too weak.
  std::uint32_t label{};  ///< Of a flake.
  ThresholdParameters threshold;
};

struct SensorDropoutParameters {
  std::uint64_t seed{};
  float probability{};
};

enum class NoiseShape { kNone, kIsotropic, kBeam, kSignal };

struct MeasurementParameters {
  std::uint64_t seed{};
  float sigma0_m{};
  float sigma1{};
  float range_min_m{};
  float range_max_m{};
  // Of NoiseShape::kSignal: sigma^2 = sigma0_m^2 + scale_m^2 / (2 SNR).
  float scale_m{};
  float snr_at_threshold{};
  const float* channel_bias_m{};  ///< By channel.
};

// Physics.

/// Where the beam's axes and the vertical are.
struct BeamFrame {
  float up[3]{0.0F, 0.0F, 1.0F};        ///< The sensor's z axis, in the rays' frame.
  float vertical[3]{0.0F, 0.0F, 1.0F};  ///< The world's, likewise.
  float sigma_h_rad{};                  ///< Standard deviations of the beam's profile.
  float sigma_v_rad{};
};

struct PointingParameters {
  std::uint64_t seed{};
  float sigma_rad{};
};

struct ResponseParameters {
  bool is_lambert{};         ///< Effect surface_response is off.
  float inverse_power_m2{};  ///< R0^2 / 0.1: 1 / P_min.
  float snow_cover{};        ///< Share of upward faces under snow.
  float snow_a{}, snow_b{};  ///< The snow's diffuse_a and diffuse_b.
};

struct SunlightParameters {
  float background_gain{};  ///< Threshold x sqrt(1 + this x background reflectance).
};

struct DetectionParameters {
  std::uint64_t seed{};
  float snr_at_threshold{};
};

}  // namespace railcast
