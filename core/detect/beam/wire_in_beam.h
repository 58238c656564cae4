#pragma once

#include "core/detect/beam/wire_set.h"
#include "railcast/transform.h"

namespace railcast {

/// A Gaussian beam in the window frame.
struct WideBeam {
  Vector3 origin_m;
  Vector3 direction;   ///< Unit vector; direction, horizontal and vertical are orthonormal.
  Vector3 horizontal;  ///< up x direction.
  Vector3 vertical;    ///< direction x horizontal.
  /// Standard deviation of the power across the beam: a quarter of the 1/e^2 full divergence.
  double sigma_horizontal_rad{};
  double sigma_vertical_rad{};
};

/// A piece of wire as a narrow strip in the plane across the beam, in units of the beam's sigmas.
struct WireStrip {
  float direction[2]{};  ///< Unit direction of its axis: horizontal, vertical.
  float offset{};        ///< Signed distance of its axis from the beam's middle.
  float begin{}, end{};  ///< Along the axis, as far as the beam reaches.
  float halves[2]{};     ///< Half of its width at begin and end.
};

/// The part of a straight piece of wire that a beam meets.
struct WireInBeam {
  double share{};  ///< Share of the beam's power that falls on the wire; 0 = the beam misses it.
  /// Mean range of the lit surface, weighted around the section by a Lambertian response.
  double range_m{};
  double spread_m{};  ///< Standard deviation of that range.
  double sin_axis{};  ///< Sine between the wire's axis and the line of sight, in [0, 1].
  WireStrip strip{};
};

/// Effect `thin_conductors`: a wire in a Gaussian beam, in closed form.
///
/// Model. In the plane across the beam (x / z, y / z) the wire's axis is exactly a straight line,
/// and 1 / range changes linearly along it. In units of the beam's sigmas the beam is circular.
/// With d the line's distance from the beam's middle, t0 and t1 the positions of its ends along the
/// line, and a = radius / range / (sigma across the line),
///
///   share  = (Phi(d + a) - Phi(d - a)) (Phi(t1) - Phi(t0))
///   range  = 1 / E[1 / range], its spread = |d range / dt| sqrt(Var[t]),   t ~ N(0, 1) in [t0, t1]
///
/// E and Var are those of the truncated normal distribution (Johnson, Kotz, Balakrishnan 1994,
/// "Continuous univariate distributions", 13.10.1). The power on a thin wire is proportional to
/// 1 / range along it, so that the first line is exact. The mean lit surface lies
/// 8 / (3 pi) radius / sin_axis nearer than the axis: the mean of sqrt(1 - u^2) weighted with
/// itself, u uniform in (-1, 1). Where the range changes by more than a fifth within the beam, the
/// piece is cut and the parts are added.
///
/// Validity: radius < 0.1 range. Ends are cut along the line of sight; their faces are not seen.
/// Points less than 1 cm in front of the sensor and wires that pass the beam's middle at more than
/// four sigmas (3e-5 of the beam) are left out. A sigma below 1e-7 rad is replaced by 1e-7 rad:
/// such a beam is a ray, and the wire catches all of it or nothing.
[[nodiscard]] WireInBeam FindWireInBeam(const WideBeam& beam, const WireSegment& wire);

/// A piece of a strip: positions along its axis, empty unless begin < end.
struct StripPart {
  float begin{}, end{};
};

/// The piece of a line along a strip, at a distance from the strip's axis, that another strip
/// covers.
/// @param aside Distance of the line from the axis of `strip`.
[[nodiscard]] StripPart CoveredPart(const WireStrip& strip, float aside, const WireStrip& other);

}  // namespace railcast
