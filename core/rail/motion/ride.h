#pragma once

#include <array>
#include <complex>
#include <cstddef>
#include <cstdint>

#include "railcast/transform.h"
#include "railcast/world_spec.h"

namespace railcast {

/// Spectra of a track's irregularities by ORE B 176, as Claus and Schiehlen 1998 ("Modeling and
/// simulation of railway bogie structural vibrations", Vehicle System Dynamics 29) give them for
/// low and high disturbances, here good and poor:
///
///   S_v(W) = A_v Wc^2 / ((W^2 + Wr^2) (W^2 + Wc^2))                        vertical, m^2 / (rad/m)
///   S_a(W) = the same with A_a                                              lateral
///   S_c(W) = A_v Wc^2 W^2 / (b^2 (W^2 + Wr^2) (W^2 + Wc^2) (W^2 + Ws^2))    cant, rad^2 / (rad/m)
///
/// Variances are their integrals over positive W, divided by pi.
struct TrackSpectrum {
  double vertical_m_rad{};  ///< A_v.
  double lateral_m_rad{};   ///< A_a.

  [[nodiscard]] double Vertical(double rad_per_m) const;
  [[nodiscard]] double Lateral(double rad_per_m) const;
  [[nodiscard]] double Cant(double rad_per_m) const;
};

[[nodiscard]] TrackSpectrum SpectrumOf(TrackQuality quality);

/// Wavelengths that count: those of EN 13848-1, D1 to D3.
inline constexpr double kShortestIrregularity_m = 3.0;
inline constexpr double kLongestIrregularity_m = 200.0;

/// Where the body of a vehicle is on its springs, seen from where it would be on a perfect track.
/// About its middle between the pivots at top of rail; x forward, y left, z up.
struct RideMotion {
  double lateral_m{};
  double vertical_m{};
  double yaw_rad{};
  double pitch_rad{};
  double roll_rad{};
};

/// A transmissibility: a mass on a spring and a damper whose foot moves.
struct Suspension {
  double frequency_hz{};
  double damping{};  ///< Share of the critical one.

  /// (1 + 2 i D r) / (1 - r^2 + 2 i D r) with r the ratio of the frequencies.
  [[nodiscard]] std::complex<double> At(double frequency_hz) const;
  /// By how much the mass is not where a force leads it, so long after this has appeared: from 1 to
  /// 0 by exp(-D w t) (cos(w' t) + D w / w' sin(w' t)), w' = w sqrt(1 - D^2).
  [[nodiscard]] double LeftOfStep(double since_s) const;
};

/// How a sprung body moves over an irregular track.
///
/// The track's irregularities are sums of waves with random phases, functions of the chainage: the
/// same place shakes every train alike. A bogie follows the mean of its two axles, and the body the
/// mean of the two bogies (vertical, lateral, roll) and their difference (pitch, yaw), each through
/// a suspension of its own at the frequency at which the speed makes it pass the wave. Speed
/// changes so slowly that each wave has settled.
///
/// Traction and brakes pull the body at the height of its links to the bogies, its inertia acts at
/// the centre of gravity, and the springs carry the moment of the two. With springs so stiff that a
/// body of mass m swings vertically at w, m w^2, at half the pivots' distance L before and behind
/// its middle, the acceleration a raises the nose by
///
///   a (h - z) / (w^2 L^2),   h - z = 1.2 m from the links to the centre of gravity
///
/// and the body follows each change of a as a mass on its spring does. From published masses and
/// stiffnesses (coach of the Manchester Benchmarks: Iwnicki 1998, Vehicle System Dynamics 30; power
/// car: Zhai, Wang and Cai 2009, Vehicle System Dynamics 47) it is 0.017 and 0.042 deg for 1 m/s^2,
/// and by this formula with their pivots 19 and 11.46 m apart 0.013 and 0.037.
///
/// Validity: a linear model. It has neither flexible bodies nor stops, nor the hunting of wheels,
/// nor what gradients and couplers do to the pitch. Frequencies and damping are working values in
/// the range of passenger vehicles (vertical 1 to 1.5 Hz, sway 0.5 to 0.8 Hz: Iwnicki 2006,
/// "Handbook of Railway Vehicle Dynamics"), and so is h - z.
class Ride {
 public:
  static constexpr double kAxleDistance_m = 2.5;  ///< In a bogie.
  static constexpr Suspension kVertical{1.2, 0.2};
  static constexpr Suspension kLateral{1.0, 0.2};
  static constexpr Suspension kRoll{0.7, 0.2};
  static constexpr double kAboveLinks_m = 1.2;  ///< Centre of gravity above the links, h - z.

  /// @param seed Of the track.
  /// @pre pivot_distance_m > 0.
  Ride(const RideSpec& spec, std::uint64_t seed, double pivot_distance_m);

  /// @param s_m Chainage of the front pivot.
  /// @param sprung_mps2 The acceleration in the direction of travel, as kVertical follows it
  ///   (SpeedProfile).
  [[nodiscard]] RideMotion At(double s_m,
                              double speed_mps,
                              bool runs_back,
                              double sprung_mps2 = 0.0) const;
  /// The vehicle's frame, which has its origin at the front pivot, seen from where it would be.
  [[nodiscard]] Transform PerfectFromVehicle(const RideMotion& motion) const;

 private:
  static constexpr std::size_t kNumWaves = 96;

  struct RideWave {
    double rad_per_m{};
    /// Amplitudes and phases of vertical, lateral and cant.
    std::array<double, 3> amplitudes{};
    std::array<double, 3> phases_rad{};
  };

  double pivot_distance_m_;
  std::array<RideWave, kNumWaves> waves_;
};

}  // namespace railcast
