#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

namespace railcast {

/// Which effects are on. A rung of the fidelity ladder is a named set.
struct EffectSet {
  // The published plausibility model.
  bool threshold = false;  ///< Reflectivity, incidence and fog against a rising threshold.
  bool rain = false;       ///< Rain dropout.
  bool snow = false;       ///< Snow clutter.
  bool noise = false;      ///< Position noise.

  bool sensor_dropout = false;  ///< Pulses the sensor misses.

  // Physics: surfaces, air and receiver.
  bool surface_response = false;       ///< Oren-Nayar, GGX and retroreflection; else Lambert.
  bool surface_condition = false;      ///< Wet and snow-covered surfaces.
  bool extinction = false;             ///< Two ways through fog, rain and snow.
  bool pulse_stretch = false;          ///< Slanting surfaces weaken an echo's peak.
  bool detection = false;              ///< The threshold that the data sheet's range implies.
  bool detection_probability = false;  ///< Smooth instead of hard.
  bool clutter = false;                ///< Echoes of rain drops and snow flakes.
  bool fog_echo = false;               ///< The soft echo of fog near the sensor.
  bool sunlight = false;               ///< A higher threshold, false alarms, the sun's disc.
  bool range_noise = false;            ///< Driven by the signal-to-noise ratio, along the beam.
  bool channel_bias = false;           ///< A constant range error of each channel.
  bool pointing_jitter = false;        ///< Beams leave beside where the sensor says they do.

  // Physics: the beam's width.
  bool footprint = false;         ///< Sub-rays where the neighbourhood needs them.
  bool thin_conductors = false;   ///< Wires by closest approach instead of by their triangles.
  bool dense_footprint = false;   ///< Hundreds of sub-rays in every beam.
  bool sampled_waveform = false;  ///< Peaks of a sampled waveform instead of closed forms.

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

/// The laser beam: a Gaussian profile, in the far field.
struct BeamSpec {
  int wavelength_nm = 905;  ///< 905 (stands for 850 to 950) or 1550.
  /// Full angle between the 1/e^2 points of the profile: horizontal, vertical. 0 = a ray.
  std::array<double, 2> divergence_mrad{3.0, 1.5};
  double pulse_length_ns = 5.0;  ///< Full width at half maximum of the pulse as received.
  int reference_rays = 256;      ///< Sub-rays of effect dense_footprint.

  bool operator==(const BeamSpec&) const = default;
};

/// What the sensor makes of the light that comes back.
struct ReceiverSpec {
  double range_at_10_percent_m = 200.0;   ///< Of the data sheet: on a facing 10 % Lambertian.
  double snr_at_threshold = 5.0;          ///< Amplitude signal-to-noise ratio there.
  std::string return_mode = "strongest";  ///< "strongest", "first", "last", "dual" or "triple".
  double range_noise_floor_m = 0.015;     ///< Standard deviation at high signal.
  double range_noise_scale_m = 0.1;       ///< sigma = hypot(floor, scale / sqrt(2 SNR)).
  double channel_bias_sigma_m = 0.01;     ///< Of the channels' constant errors.
  double pointing_jitter_deg = 0.01;      ///< Standard deviation in each of two directions.
  double clutter_gain = 0.2;              ///< Multiplies the mean number of drop and flake echoes.

  bool operator==(const ReceiverSpec&) const = default;
};

/// The sun as the sensor sees it.
struct SunSpec {
  double illuminance_klx = 0.0;  ///< 100 = full sun.
  double azimuth_deg = 180.0;    ///< In the world: from +x (east) towards +y (north).
  double elevation_deg = 35.0;

  bool operator==(const SunSpec&) const = default;
};

struct WeatherSpec {
  double fog_density_per_m = 0.0;      ///< Extinction; the published model applies it one way.
  std::optional<double> visibility_m;  ///< Instead: extinction = ln 20 / this (5 % contrast).
  double rain_rate_mmph = 0.0;
  std::string rain_drop_sizes = "marshall_palmer";  ///< Or "drizzle", "thunderstorm".
  double rain_dropout_per_m = 3.65e-4;              ///< Rain dropout rate at 1 mm/h.
  double rain_dropout_exponent = 0.63;              ///< Its growth with the rain rate.
  double snow_rate_mmph = 0.0;
  std::string snow_type = "dry";       ///< Or "wet".
  double snow_echoes_per_mmph = 0.02;  ///< Mean detectable flakes per beam at 1 mm/h.
  double snow_range_scale_m = 5.0;     ///< Maxwell scale of their ranges (median 1.538 x).
  double snow_intensity = 0.02;        ///< Effective reflectance that a flake shows.
  double wetness = 0.0;                ///< Of surfaces: 0 = dry, 1 = soaked.
  double snow_cover = 0.0;             ///< Share of each upward surface that snow lies on.
  SunSpec sun;

  bool operator==(const WeatherSpec&) const = default;
};

}  // namespace railcast
