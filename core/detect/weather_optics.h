#pragma once

#include "core/detect/detect_spec.h"

namespace railcast {

/// Extinction of fog, m^-1, one way: ln 20 / visibility (5 % contrast, as meteorologists define
/// it), or the density where no visibility is given.
[[nodiscard]] double FogExtinction_per_m(const WeatherSpec& weather);

/// An exponential distribution of particle diameters, N(D) = intercept e^(-slope D).
struct ParticleSizes {
  double intercept_per_m3_mm{};  ///< m^-3 mm^-1
  double slope_per_mm{};
};

/// Drops of rain: Marshall and Palmer 1948, or Joss and others' drizzle and thunderstorm.
/// @pre rain_rate_mmph > 0.
[[nodiscard]] ParticleSizes RainDropSizes(const WeatherSpec& weather);
/// Flakes of snow by their melted diameter (Gunn and Marshall 1958, as LISA uses it).
/// @pre snow_rate_mmph > 0.
[[nodiscard]] ParticleSizes SnowFlakeSizes(const WeatherSpec& weather);

/// Extinction of rain, m^-1, one way: particles much larger than the wavelength take twice their
/// cross-section, so that the integral over the drop sizes is pi N0 / slope^3 (physics.md 4.1;
/// 3.65e-4 RR^0.63 with Marshall and Palmer's). 0 without rain.
[[nodiscard]] double RainExtinction_per_m(const WeatherSpec& weather);
/// Extinction of wet or dry snow, m^-1, one way (ITU-R P.1814). 0 without snow.
[[nodiscard]] double SnowExtinction_per_m(const WeatherSpec& weather, int wavelength_nm);

/// All three together: what effect `extinction` applies there and back.
[[nodiscard]] double Extinction_per_m(const WeatherSpec& weather, int wavelength_nm);

/// How much brightness raises the threshold, per unit of background reflectance: the threshold is
/// multiplied by sqrt(1 + this x reflectance). So chosen that full sun (100 klx) on a background of
/// 80 % takes 29 % of the range, as a data sheet has it (Livox Avia, physics.md 6).
[[nodiscard]] double SunBackgroundGain(const SunSpec& sun);
/// Probability of a false alarm in a firing: 1e-6 at night, 1e-4 in full sun (physics.md 6).
[[nodiscard]] double FalseAlarmProbability(const SunSpec& sun);

/// The soft echo of fog (physics.md 4.3): where it peaks, and its effective reflectance there.
struct FogEcho {
  double range_m{};
  double intensity{};
};

/// A volume of droplets within a pulse's length answers like a surface of reflectance
/// pi beta c tau / 2 with beta = extinction / 65 sr; the receiver sees it where transmitter and
/// receiver overlap, from 1 m on in proportion, wholly from 3 m on.
[[nodiscard]] FogEcho FogEchoOf(const WeatherSpec& weather, const BeamSpec& beam);

/// Echoes of the drops or flakes in a beam (physics.md 4.2). A particle of diameter D at r answers
/// with rho_p (D / (theta r))^2 / r^2; those stronger than P_min are Poisson in number, and their
/// ranges follow Maxwell's law.
struct ParticleEchoes {
  double mean_count{};
  double range_scale_m{};  ///< Maxwell's a; the median is 1.538 a.
  /// Least diameter that answers at 1 m, in units of the mean diameter; grows with r squared.
  double least_diameter_per_m2{};
};

/// @param reflectance rho_p: 0.02 of drops, 0.6 of flakes.
/// @param power_min P_min: 0.1 / R0^2 for any echo; the power of a surface for those that outdo it.
[[nodiscard]] ParticleEchoes ParticleEchoesOf(const ParticleSizes& sizes,
                                              double reflectance,
                                              const BeamSpec& beam,
                                              double power_min);

inline constexpr double kDropReflectance = 0.02;
inline constexpr double kFlakeReflectance = 0.6;

}  // namespace railcast
