#pragma once

#include "core/base/transform.h"
#include "core/detect/wire_set.h"

namespace railcast {

/// A Gaussian beam in the window frame.
struct WideBeam {
  Vector3 origin_m;
  Vector3 direction;   ///< Unit length, as the two axes; all at right angles.
  Vector3 horizontal;  ///< up x direction.
  Vector3 vertical;    ///< direction x horizontal.
  /// Standard deviation of the power across the beam: a quarter of the 1/e^2 full divergence.
  double sigma_horizontal_rad{};
  double sigma_vertical_rad{};
};

/// What a beam meets of a straight piece of wire.
struct WireInBeam {
  double share{};  ///< Of the beam's power that falls on it; 0 = it misses.
  double
      range_m{};  ///< Mean of the lit surface, weighted round the section as a Lambertian answers.
  double spread_m{};  ///< Standard deviation of the same.
  double sin_axis{};  ///< Sine between the wire's axis and the line of sight, in [0, 1].
};

/// Effect `thin_conductors`: a wire in a Gaussian beam, in closed form.
///
/// Model. In the plane across the beam (x / z, y / z) the wire's axis is a straight line exactly,
/// and 1 / range changes linearly along it. Divided by the beam's sigmas the beam is round: with d
/// the line's distance from the beam's middle, t0 and t1 its ends along it, and a = radius / range
/// / sigma across it,
///
///   share  = (Phi(d + a) - Phi(d - a)) (Phi(t1) - Phi(t0))
///   range  = 1 / E[1 / range], its spread = |d range / dt| sqrt(Var[t]),   t ~ N(0, 1) in [t0, t1]
///
/// E and Var are those of the truncated normal distribution (Johnson, Kotz, Balakrishnan 1994,
/// "Continuous univariate distributions", 13.10.1). A thin wire's light is in proportion to
/// 1 / range along it, so that the first line is exact. The surface lies 8 / (3 pi) radius /
/// sin_axis nearer than the axis: the mean of sqrt(1 - u^2) with itself as weight, u even in (-1,
/// 1). Where the range changes by more than a fifth within the beam, the piece is cut and the parts
/// are added.
///
/// Validity: radius < 0.1 range. An end is cut along the line of sight, and its face not seen. What
/// is less than 1 cm in front of the sensor is left out, and a wire that passes the beam's middle
/// at more than four sigmas (3e-5 of the beam). A sigma below 1e-7 rad counts as that: a ray, which
/// the wire catches whole or not at all.
[[nodiscard]] WireInBeam FindWireInBeam(const WideBeam& beam, const WireSegment& wire);

}  // namespace railcast
