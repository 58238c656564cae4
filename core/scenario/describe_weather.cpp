#include "core/scenario/descriptions.h"

#include "railcast/effects.h"

namespace railcast {
namespace {

/// The published system gives rain as an intensity from 0 to 1. Intensity 1 is 50 mm/h, from which
/// rain is called violent; the rate is proportional to the intensity.
constexpr double kRainAtFullIntensity_mmph = 50.0;

/// The heaviest recorded rain within a minute has a rate of about 2000 mm/h.
[[nodiscard]] Limits PrecipitationLimits() {
  return Within(0, 5000);
}

}  // namespace

void Describe(Archive& a, SunSpec& s) {
  a.Optional("illuminance_klx", s.illuminance_klx, "100 = full sun, 0 = night.", Within(0, 150));
  a.Optional("azimuth_deg", s.azimuth_deg, "In the world: from +x (east) towards +y (north).",
             Within(-360, 360));
  a.Optional("elevation_deg", s.elevation_deg, "Elevation above the horizon.", Within(-90, 90));
}

void Describe(Archive& a, WeatherSpec& s) {
  a.OneOfTwo("visibility_m", "fog_density_per_m");
  a.OneOfTwo("rain_intensity", "rain_rate_mmph");
  a.Optional("fog_density_per_m", s.fog_density_per_m,
             "Extinction; the published model applies it one way, physics both ways.",
             Within(0, 10));
  a.Optional("visibility_m", s.visibility_m,
             "Meteorological, at 5 % contrast, instead of fog_density_per_m: the extinction is "
             "ln 20 / this.",
             Within(0.3, 1e9));
  a.Ensure({"visibility_m", "fog_density_per_m"}, !s.visibility_m || s.fog_density_per_m == 0.0,
           "must not be given together with \"fog_density_per_m\"");
  a.Optional("fog_variation", s.fog_variation,
             "Standard deviation of the logarithm of the droplets' density in space; 0 = uniform.",
             Within(0, 1));
  a.Optional("rain_rate_mmph", s.rain_rate_mmph, "Rain in mm/h.", PrecipitationLimits());
  a.Alternative("rain_intensity", s.rain_rate_mmph, {"rain_rate_mmph", kRainAtFullIntensity_mmph},
                "The published intensity, instead of rain_rate_mmph: 1 is 50 mm/h.", Within(0, 1));
  a.Optional("rain_drop_sizes", s.rain_drop_sizes,
             "Drop-size distribution: Marshall-Palmer, or more small or more large drops.");
  a.Optional("rain_dropout_per_m", s.rain_dropout_per_m, "Rain dropout rate at 1 mm/h.",
             Within(0, 10));
  a.Optional("rain_dropout_exponent", s.rain_dropout_exponent,
             "Exponent of the rain rate in the dropout rate.", Within(0, 10));
  a.Optional("snow_rate_mmph", s.snow_rate_mmph, "Snow in mm/h of water.", PrecipitationLimits());
  a.Optional("snow_type", s.snow_type, "Kind of snow, on which its extinction depends.");
  a.Optional("snow_echoes_per_mmph", s.snow_echoes_per_mmph,
             "Mean detectable flakes per beam at 1 mm/h.", Within(0, 1000));
  a.Optional("snow_range_scale_m", s.snow_range_scale_m,
             "Maxwell scale of the flakes' ranges; the median is 1.538 times this.",
             Within(1e-3, 10'000));
  a.Optional("snow_intensity", s.snow_intensity, "Effective reflectance of a flake.",
             Within(0, 100));
  a.Optional("wetness", s.wetness,
             "Wetness of surfaces: 0 = dry, 1 = soaked. If absent, rain wets them: a quarter for "
             "each mm/h, at most 1.",
             Within(0, 1));
  a.Optional("snow_cover", s.snow_cover, "Snow-covered share of each upward surface.",
             Within(0, 1));
  a.Optional("puddle_share", s.puddle_share,
             "Share of level ground that holds puddles under standing water.", Within(0, 1));
  a.Optional("spray_extinction_per_m", s.spray_extinction_per_m,
             "Extinction of the spray at a train of 100 km/h on soaked or snow-covered ground.",
             Within(0, 10));
  a.Optional("sun", s.sun, "The sun as the sensor sees it.");
  a.Optional("wind_speed_mps", s.wind_speed_mps,
             "Mean wind at 10 m height, in which trees and wires sway; 0 = they stand still.",
             Within(0, 30));
  a.Optional("wind_direction_deg", s.wind_direction_deg,
             "Where the wind blows from, in the world: from +x (east) towards +y (north).",
             Within(-360, 360));
}

}  // namespace railcast
