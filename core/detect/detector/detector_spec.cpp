#include "railcast/effects.h"

#include <cmath>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/base/text.h"
#include "railcast/ray_caster.h"

namespace railcast {
namespace {

/// What a number must be. The scenario reader is stricter (core/scenario/describe_lidar.h); these
/// are the rules without which detection aborts or gives nonsense.
struct NumberRule {
  const char* place;
  double value;
  bool holds;
  const char* rule;
};

bool IsPositive(double value) {
  return value > 0.0 && std::isfinite(value);
}

bool IsShare(double value) {
  return value >= 0.0 && value <= 1.0;
}

bool IsNonNegative(double value) {
  return value >= 0.0 && std::isfinite(value);
}

// Within these limits, the number of spots stays below a million and a beam meets some thousands.
std::vector<NumberRule> CoverRules(const CoverSpec& cover) {
  const auto spot = [](const char* place, double diameter_mm) {
    return NumberRule{place, diameter_mm, diameter_mm >= 1.0 && diameter_mm <= 20.0,
                      ">= 1 and <= 20"};
  };
  const auto share = [](const char* place, double coverage) {
    return NumberRule{place, coverage, coverage >= 0.0 && coverage <= 0.9, ">= 0 and <= 0.9"};
  };
  return {{"/cover/window_radius_mm", cover.window_radius_mm,
           cover.window_radius_mm >= 20.0 && cover.window_radius_mm <= 150.0, ">= 20 and <= 150"},
          {"/cover/aperture_mm", cover.aperture_mm,
           cover.aperture_mm >= 1.0 && cover.aperture_mm <= 30.0, ">= 1 and <= 30"},
          {"/cover/drop_lifetime_s", cover.drop_lifetime_s,
           cover.drop_lifetime_s >= 0.1 && std::isfinite(cover.drop_lifetime_s), ">= 0.1"},
          share("/cover/drop_coverage", cover.drop_coverage),
          spot("/cover/drop_diameter_mm", cover.drop_diameter_mm),
          share("/cover/dirt_coverage", cover.dirt_coverage),
          spot("/cover/dirt_diameter_mm", cover.dirt_diameter_mm),
          share("/cover/snow_coverage", cover.snow_coverage),
          spot("/cover/snow_diameter_mm", cover.snow_diameter_mm)};
}

}  // namespace

void CheckDetectorSpec(const DetectorSpec& spec) {
  const BeamSpec& beam = spec.beam;
  const ReceiverSpec& receiver = spec.receiver;
  const WeatherSpec& weather = spec.weather;
  constexpr int kMostReferenceRays = 4096;
  const double visibility_m = weather.visibility_m.value_or(1.0);
  const double saturation = receiver.saturation_power_ratio.value_or(2.0);
  const double wetness = weather.wetness.value_or(0.0);
  std::vector<NumberRule> rules = {
      {"/range_min_m", spec.range_min_m, IsNonNegative(spec.range_min_m), ">= 0"},
      {"/range_max_m", spec.range_max_m, IsPositive(spec.range_max_m), "> 0"},
      {"/beam/wavelength_nm", static_cast<double>(beam.wavelength_nm),
       beam.wavelength_nm == 905 || beam.wavelength_nm == 1550, "905 or 1550"},
      {"/beam/divergence_mrad/0", beam.divergence_mrad[0], IsNonNegative(beam.divergence_mrad[0]),
       ">= 0"},
      {"/beam/divergence_mrad/1", beam.divergence_mrad[1], IsNonNegative(beam.divergence_mrad[1]),
       ">= 0"},
      {"/beam/pulse_length_ns", beam.pulse_length_ns, IsPositive(beam.pulse_length_ns), "> 0"},
      {"/beam/reference_rays", static_cast<double>(beam.reference_rays),
       beam.reference_rays >= 1 && beam.reference_rays <= kMostReferenceRays, ">= 1 and <= 4096"},
      {"/beam/footprint_rays", static_cast<double>(beam.footprint_rays),
       beam.footprint_rays == static_cast<int>(kNumCrowdedSubRays) ||
           beam.footprint_rays == static_cast<int>(kNumSubRays),
       "16 or 64"},
      {"/receiver/range_at_10_percent_m", receiver.range_at_10_percent_m,
       IsPositive(receiver.range_at_10_percent_m), "> 0"},
      {"/receiver/snr_at_threshold", receiver.snr_at_threshold,
       IsPositive(receiver.snr_at_threshold), "> 0"},
      {"/receiver/dead_time_ns", receiver.dead_time_ns, IsNonNegative(receiver.dead_time_ns),
       ">= 0"},
      {"/plausibility/dark_dropout_probability", spec.plausibility.dark_dropout_probability,
       IsShare(spec.plausibility.dark_dropout_probability), ">= 0 and <= 1"},
      {"/plausibility/dark_dropout_intensity", spec.plausibility.dark_dropout_intensity,
       spec.plausibility.dark_dropout_intensity > 0.0, "> 0"},
      {"/plausibility/dropout_per_m", spec.plausibility.dropout_per_m,
       IsNonNegative(spec.plausibility.dropout_per_m), ">= 0"},
      {"/receiver/halo_share_at_1_deg", receiver.halo_share_at_1_deg,
       IsShare(receiver.halo_share_at_1_deg), ">= 0 and <= 1"},
      {"/receiver/foreign_pulses_hz", receiver.foreign_pulses_hz,
       IsNonNegative(receiver.foreign_pulses_hz), ">= 0"},
      {"/receiver/saturation_power_ratio", saturation, saturation >= 2.0, ">= 2"},
      {"/receiver/ghost_reflectance", receiver.ghost_reflectance,
       IsShare(receiver.ghost_reflectance), ">= 0 and <= 1"},
      {"/receiver/range_walk_m", receiver.range_walk_m, IsNonNegative(receiver.range_walk_m),
       ">= 0"},
      {"/weather/fog_density_per_m", weather.fog_density_per_m,
       IsNonNegative(weather.fog_density_per_m), ">= 0"},
      {"/weather/visibility_m", visibility_m, visibility_m > 0.0, "> 0"},
      {"/weather/rain_rate_mmph", weather.rain_rate_mmph, IsNonNegative(weather.rain_rate_mmph),
       ">= 0"},
      {"/weather/snow_rate_mmph", weather.snow_rate_mmph, IsNonNegative(weather.snow_rate_mmph),
       ">= 0"},
      {"/weather/wetness", wetness, IsShare(wetness), ">= 0 and <= 1"},
      {"/weather/snow_cover", weather.snow_cover, IsShare(weather.snow_cover), ">= 0 and <= 1"},
      {"/weather/puddle_share", weather.puddle_share, IsShare(weather.puddle_share),
       ">= 0 and <= 1"},
      {"/weather/spray_extinction_per_m", weather.spray_extinction_per_m,
       IsNonNegative(weather.spray_extinction_per_m), ">= 0"},
      {"/weather/wind_speed_mps", weather.wind_speed_mps, IsNonNegative(weather.wind_speed_mps),
       ">= 0"},
      {"/weather/wind_direction_deg", weather.wind_direction_deg,
       std::isfinite(weather.wind_direction_deg), "finite"},
  };
  for (const NumberRule& rule : CoverRules(spec.cover)) rules.push_back(rule);
  ErrorList errors;
  for (const auto& [place, value, holds, rule] : rules) {
    if (holds) continue;
    errors.Add({std::string(place), std::string("must be ") + rule, NumberText(value)});
  }
  errors.ThrowIfAny();
}

}  // namespace railcast
