#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "railcast/scene.h"
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

/// The blow-off of a span of the contact line: contact wire, messenger and droppers move aside as
/// one, by a parabola between the supports,
///
///   e(x) = q x (L - x) / (2 T),   q = 1/2 rho C d u |u|
///
/// with the component u of the mean wind across the span, the sum d of the wires' diameters, the
/// sum T of their tensions, C = 1 and rho = 1.25 kg/m^3 (EN 50119 6.2; Kiessling and others,
/// "Contact lines for electric railways").
///
/// Sway about the mean, relative to it: 2 I (B g + R r), with the gusts g at mid-span, the ringing
/// r and R of Wind for a width of L, and B^2 = 0.8 / (1 + 0.9 (L / 63 m)^0.63), since gusts do not
/// cover the whole span (EN 1991-1-4 B.3). Natural frequency: f0 = sqrt(T / m) / (2 L), that of a
/// string; damping ratio 0.01 (working value) + rho C d |u| / (2 m 2 pi f0), the air's drag.
///
/// Supports stand still. Not modelled: vertical movement, waves of higher order, the push of a
/// pantograph, and the different sway of the two wires.
/// @param span In the world frame.
/// @return The displacement at mid-span, to the left of the way from `begin_m` to `end_m`.
[[nodiscard]] double SpanBlowOff_m(const Wind& wind, const WireSpan& span, double time_s);

/// The mean of SpanBlowOff_m().
[[nodiscard]] double MeanSpanBlowOff_m(const Wind& wind, const WireSpan& span);
/// Standard deviation of SpanBlowOff_m(), relative to its mean.
struct SpanGusts {
  double frequency_hz{};
  double damping{};
  double slow{};     ///< 2 I B
  double ringing{};  ///< 2 I R
};
[[nodiscard]] SpanGusts SpanGustsOf(const Wind& wind, const WireSpan& span);

/// The unit vector to the left of the span, level.
[[nodiscard]] Vector3 LeftOf(const WireSpan& span);
/// Displacement of a point of a wire as a share of that at mid-span, 4 x (L - x) / L^2, with x
/// measured in plan.
[[nodiscard]] double BlowOffShare(const WireSpan& span, const Vector3& point_m);

/// What a tree's sway depends on besides the wind.
struct TreeInWind {
  Vector3 foot_world_m = Vector3::Zero();
  double height_m{};
  std::uint32_t chunk{};  ///< With `number`, keys the tree's own draws.
  std::uint32_t number{};
};

/// A tree as a damped oscillator which the wind drives.
///
/// Natural frequency: f0 = 0.0766 + 3.1219 dbh / h^2 (Hz; dbh in cm, h in m; Moore, Maguire 2004,
/// 602 conifers). Our trees have dbh = 2.2 cm per metre of height (2.14 to 2.27), so that
/// f0 = 0.0766 + 6.868 / h. Damping ratio 0.1 (8 % and more in leaf: Moore, Maguire 2005).
///
/// Mean displacement of the tip, downwind: 0.015 h (U / 10 m/s)^n with n = 4/3. Crowns streamline,
/// so that their drag grows more slowly than U^2 (about as U: Vollsinger and others 2005; as U^1.3:
/// de Langre 2008). The factor is a working value: 0.008 if the trunk alone bends as a tapering
/// beam of 7.5 GPa, 0.036 if an oscillator of f0 with the crown's mass takes the drag.
///
/// Sway about the mean, relative to it: n I (sqrt(0.8) g + R r) along the wind, with the gusts g,
/// the ringing r and R of Wind; across it 0.8 I sqrt(0.8 + R^2) r', all of it at f0, since
/// sigma_v / sigma_u = 0.8 (Panofsky, Dutton 1984).
///
/// The whole tree leans about its foot by tip / h (rad). Trunks bend more towards the tip, branches
/// sway by themselves and leaves flutter: none of that is modelled.
[[nodiscard]] Vector3 TreeTip_m(const Wind& wind, const TreeInWind& tree, double time_s);

[[nodiscard]] double TreeFrequency_hz(double height_m);
[[nodiscard]] double MeanTreeTip_m(double wind_mps, double height_m);

inline constexpr double kTreeDamping = 0.1;
inline constexpr double kTreeDragExponent = 4.0 / 3.0;
/// Ratio of the wind's fluctuation across to that along it.
inline constexpr double kAcrossGusts = 0.8;

}  // namespace railcast
