#include "core/detect/base/weather_optics.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/text.h"
#include "core/detect/base/beam_optics.h"

namespace railcast {
namespace {

constexpr double kDbPerKmOf1PerM = 4343.0;  // 10 log10(e) dB per unit of optical depth, x 1000 m.

}  // namespace

double FogExtinction_per_m(const WeatherSpec& weather) {
  return weather.visibility_m ? std::log(20.0) / *weather.visibility_m : weather.fog_density_per_m;
}

std::string FogText(const WeatherSpec& weather) {
  return "fog " + ShortText(FogExtinction_per_m(weather)) + " per m";
}

ParticleSizes RainDropSizes(const WeatherSpec& weather) {
  const double power = std::pow(weather.rain_rate_mmph, -0.21);
  switch (weather.rain_drop_sizes) {
    case RainDrops::kDrizzle:
      return {30'000.0, 5.7 * power};
    case RainDrops::kThunderstorm:
      return {1'400.0, 3.0 * power};
    case RainDrops::kMarshallPalmer:
      break;
  }
  return {8'000.0, 4.1 * power};
}

ParticleSizes SnowFlakeSizes(const WeatherSpec& weather) {
  return {7.6e3 * std::pow(weather.snow_rate_mmph, -0.87),
          2.55 * std::pow(weather.snow_rate_mmph, -0.48)};
}

double RainExtinction_per_m(const WeatherSpec& weather) {
  if (weather.rain_rate_mmph <= 0.0) return 0.0;
  const ParticleSizes sizes = RainDropSizes(weather);
  constexpr double kM2PerMm2 = 1e-6;
  return std::numbers::pi * sizes.intercept_per_m3_mm / std::pow(sizes.slope_per_mm, 3.0) *
         kM2PerMm2;
}

double SnowExtinction_per_m(const WeatherSpec& weather, int wavelength_nm) {
  const double rate = weather.snow_rate_mmph;
  if (rate <= 0.0) return 0.0;
  const double db_per_km = weather.snow_type == SnowType::kWet
                               ? (1.023e-4 * wavelength_nm + 3.7855) * std::pow(rate, 0.72)
                               : (5.42e-5 * wavelength_nm + 5.4959) * std::pow(rate, 1.38);
  return db_per_km / kDbPerKmOf1PerM;
}

double WetnessOf(const WeatherSpec& weather) {
  return weather.wetness.value_or(std::min(1.0, weather.rain_rate_mmph / kSoakingRain_mmph));
}

double Extinction_per_m(const WeatherSpec& weather, int wavelength_nm) {
  return FogExtinction_per_m(weather) + RainExtinction_per_m(weather) +
         SnowExtinction_per_m(weather, wavelength_nm);
}

double SunBackgroundGain(const SunSpec& sun) {
  constexpr double kRangeLeft = 0.71;
  constexpr double kBackground = 0.8;
  constexpr double kFullSun_klx = 100.0;
  const double gain_in_full_sun = (std::pow(kRangeLeft, -4.0) - 1.0) / kBackground;
  return gain_in_full_sun * sun.illuminance_klx / kFullSun_klx;
}

double FalseAlarmProbability(const SunSpec& sun) {
  return std::lerp(1e-6, 1e-4, sun.illuminance_klx / 100.0);
}

ParticleEchoes ParticleEchoesOf(const ParticleSizes& sizes,
                                double reflectance,
                                const BeamSpec& beam,
                                double power_min) {
  // Replace the elliptical beam by a circular one of the same solid angle.
  const double theta_rad = 1e-3 * std::sqrt(beam.divergence_mrad[0] * beam.divergence_mrad[1]);
  if (theta_rad <= 0.0) return {};
  constexpr double kMmPerM = 1000.0;
  // A particle is detectable if D >= theta r^2 sqrt(P_min / rho_p), so that the density of echoes
  // along the beam is (pi theta^2 / 4) (N0 / slope) r^2 e^(-b r^2).
  const double b = kMmPerM * sizes.slope_per_mm * theta_rad * std::sqrt(power_min / reflectance);
  const double density_per_m3 = sizes.intercept_per_m3_mm / sizes.slope_per_mm;
  return {.mean_count = 0.25 * std::numbers::pi * theta_rad * theta_rad * density_per_m3 *
                        std::sqrt(std::numbers::pi) / (4.0 * std::pow(b, 1.5)),
          .range_scale_m = 1.0 / std::sqrt(2.0 * b),
          .least_diameter_per_m2 = b};
}

}  // namespace railcast
