#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "railcast/transform.h"

namespace railcast {

/// The wind of a scenario: what moves trees (tree_sway.h) and wires (span_sway.h).
///
/// Mean wind and turbulence are those of EN 1991-1-4 over open country (terrain category II,
/// z0 = 0.05 m) at 10 m height: intensity I = 1 / ln(z / z0) = 0.189 (4.7), length
/// L = 300 m (z / 200 m)^0.52 = 63 m (B.1), and, of the fluctuation along the wind, the share
///
///   S_L = 6.8 x / (1 + 10.2 x)^(5/3),   x = f L / U                                 (B.2, Kaimal)
///
/// of variance per ln f. Integrated, C(x) = 1 - (1 + 10.2 x)^(-2/3).
///
/// What is slower than L / U, C(1) = 80 % of the variance, is a field of gusts which the wind
/// carries along (Taylor's hypothesis): 12 plane waves of equal variance,
///
///   g(p, t) = sqrt(2 / 12) sum cos(2 pi (f (p . (w + s tan psi) / U - t) + phi))
///
/// with w downwind and s to its left, f drawn from the spectrum, one wave from each twelfth of the
/// variance, psi uniform within 45 degrees (ours) and phi uniform. It has mean 0 and variance 1.
/// Things follow it at once. What is faster makes a thing ring at its own frequency f0 with the
/// variance R^2, relative to that of a thing which follows the whole spectrum at once:
///
///   R^2 = pi^2 / (2 delta) S_L(f0) R_b,   R_b = 1 / eta - (1 - e^(-2 eta)) / (2 eta^2),
///   eta = 4.6 b / L x,   delta = 2 pi zeta                                     (B.6, B.7, B.8)
///
/// for a width b and a damping ratio zeta. The line of a damped oscillator is represented by three
/// sinusoids, the medians of its thirds: f0 (1 + {-1, 0, 1} sqrt(3) zeta).
///
/// A function of seed, place and time, so that all sensors of a vehicle and all frames see the same
/// wind. Valid for winds of 2 to 30 m/s; neither hills nor the train's own wake are modelled.
class Wind {
 public:
  /// No wind.
  Wind() = default;
  Wind(const Vector3& velocity_mps, std::uint64_t seed);

  static constexpr double kTurbulence = 0.1887;  ///< I
  static constexpr double kLength_m = 63.1;      ///< L
  static constexpr double kSlowShare = 0.800;    ///< C(1)

  [[nodiscard]] bool blows() const { return speed_mps_ > 0.0; }
  [[nodiscard]] double speed_mps() const { return speed_mps_; }
  [[nodiscard]] const Vector3& downwind() const { return downwind_; }  ///< Unit vector, level.
  [[nodiscard]] std::uint64_t seed() const { return seed_; }

  /// The field of gusts g at a place of the world.
  [[nodiscard]] double Gust(const Vector3& place_m, double time_s) const;
  /// R^2 of a thing of width `width_m` across the wind.
  [[nodiscard]] double Resonance(double frequency_hz, double damping, double width_m) const;

 private:
  static constexpr std::size_t kNumWaves = 12;
  struct Wave {
    Vector3 turns_per_m = Vector3::Zero();
    double frequency_hz{};
    double phase_turns{};
  };
  Vector3 downwind_ = Vector3::UnitX();
  double speed_mps_ = 0.0;
  std::uint64_t seed_ = 0;
  std::array<Wave, kNumWaves> waves_{};
};

/// The ringing of a thing at its own frequency: mean 0, variance 1.
/// @param words Random words, of which the first three give the phases.
[[nodiscard]] double Ringing(const std::array<std::uint32_t, 4>& words,
                             double frequency_hz,
                             double damping,
                             double time_s);

}  // namespace railcast
