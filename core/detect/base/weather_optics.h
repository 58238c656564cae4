#pragma once

#include <string>

#include "railcast/effects.h"

namespace railcast {

/// Extinction coefficient of fog, m^-1: ln 20 / visibility (meteorological optical range, 5 %
/// contrast), or the fog density if no visibility is given.
[[nodiscard]] double FogExtinction_per_m(const WeatherSpec& weather);

/// Describes the extinction of fog: "fog 0.02 per m".
[[nodiscard]] std::string FogText(const WeatherSpec& weather);

/// An exponential distribution of particle diameters, N(D) = intercept e^(-slope D).
struct ParticleSizes {
  double intercept_per_m3_mm{};  ///< m^-3 mm^-1
  double slope_per_mm{};
};

/// Sizes of rain drops: Marshall and Palmer 1948, or drizzle and thunderstorm by Joss et al.
/// @pre rain_rate_mmph > 0.
[[nodiscard]] ParticleSizes RainDropSizes(const WeatherSpec& weather);
/// Sizes of snow flakes by melted diameter (Gunn and Marshall 1958, as used in LISA).
/// @pre snow_rate_mmph > 0.
[[nodiscard]] ParticleSizes SnowFlakeSizes(const WeatherSpec& weather);

/// Extinction coefficient of rain, m^-1. The extinction cross-section of particles much larger than
/// the wavelength is twice their geometric cross-section, so that the integral over the drop sizes
/// is pi N0 / slope^3 (docs/physics.md 4.1; 3.65e-4 RR^0.63 with Marshall and Palmer's drop sizes).
/// 0 without rain.
[[nodiscard]] double RainExtinction_per_m(const WeatherSpec& weather);
/// Extinction coefficient of wet or dry snow, m^-1 (ITU-R P.1814). 0 without snow.
[[nodiscard]] double SnowExtinction_per_m(const WeatherSpec& weather, int wavelength_nm);

/// Sum of the extinction coefficients of fog, rain and snow, which effect `extinction` applies both
/// ways.
[[nodiscard]] double Extinction_per_m(const WeatherSpec& weather, int wavelength_nm);

/// Gain with which sunlight raises the threshold, per unit of background reflectance: the threshold
/// is multiplied by sqrt(1 + gain x reflectance). It is chosen so that full sun (100 klx) on a
/// background of 80 % reduces the range by 29 %, as in a data sheet (Livox Avia, docs/physics.md
/// 6).
[[nodiscard]] double SunBackgroundGain(const SunSpec& sun);
/// Probability of a false alarm in a firing: 1e-6 at night, 1e-4 in full sun (docs/physics.md 6).
[[nodiscard]] double FalseAlarmProbability(const SunSpec& sun);

/// Echoes of the drops or flakes in a beam (docs/physics.md 4.2). A particle of diameter D at range
/// r returns the power rho_p (D / (theta r))^2 / r^2. The number of particles with more than P_min
/// is Poisson distributed, and their ranges follow Maxwell's law.
struct ParticleEchoes {
  double mean_count{};
  double range_scale_m{};  ///< Maxwell's a; the median is 1.538 a.
  /// Least detectable diameter at 1 m in units of the mean diameter; grows with r squared.
  double least_diameter_per_m2{};
};

/// Computes number and ranges of the echoes that particles send.
/// @param reflectance rho_p: kDropReflectance or kFlakeReflectance.
/// @param power_min P_min: 0.1 / R0^2 to count all detectable echoes, or the power of a surface's
///   echo to count only those that exceed it.
[[nodiscard]] ParticleEchoes ParticleEchoesOf(const ParticleSizes& sizes,
                                              double reflectance,
                                              const BeamSpec& beam,
                                              double power_min);

inline constexpr double kDropReflectance = 0.02;
inline constexpr double kFlakeReflectance = 0.6;

}  // namespace railcast
