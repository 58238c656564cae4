#pragma once

#include <string>

namespace railcast {

/// Which effects are on. A rung of the fidelity ladder is a named set.
struct EffectSet {
  bool threshold = false;       ///< Reflectivity, incidence and fog against a rising threshold.
  bool rain = false;            ///< Rain dropout.
  bool snow = false;            ///< Snow clutter.
  bool noise = false;           ///< Position noise.
  bool sensor_dropout = false;  ///< Pulses the sensor misses.

  bool operator==(const EffectSet&) const = default;
};

/// The published plausibility model's parameters (each effect's header states its formula).
struct PlausibilitySpec {
  double reference_threshold = 0.1;       ///< Least detectable reflectivity x cos x fog at ...
  double reference_range_m = 200.0;       ///< ... this range; grows with range squared.
  double noise_sigma0_m = 0.01;           ///< Standard deviation of the noise at range 0.
  double noise_sigma1 = 1e-4;             ///< Its growth per metre of range.
  std::string noise_shape = "isotropic";  ///< "isotropic" (as published) or "beam".
  double dropout_probability = 0.0;       ///< Of any firing, whatever it hit.

  bool operator==(const PlausibilitySpec&) const = default;
};

struct WeatherSpec {
  double fog_density_per_m = 0.0;  ///< Extinction, applied one way as published.
  double rain_rate_mmph = 0.0;
  double rain_dropout_per_m = 3.65e-4;  ///< Rain dropout rate at 1 mm/h.
  double rain_dropout_exponent = 0.63;  ///< Its growth with the rain rate.
  double snow_rate_mmph = 0.0;
  double snow_echoes_per_mmph = 0.02;  ///< Mean detectable flakes per beam at 1 mm/h.
  double snow_range_scale_m = 5.0;     ///< Maxwell scale of their ranges (median 1.538 x).
  double snow_intensity = 0.02;        ///< Effective reflectance that a flake shows.

  bool operator==(const WeatherSpec&) const = default;
};

}  // namespace railcast
