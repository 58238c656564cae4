#pragma once

#include <array>

#include "core/detect/beam/wire_set.h"
#include "railcast/transform.h"

namespace railcast {

/// A line along a cylinder, seen by a distant sensor.
struct CylinderLine {
  double cosine{};  ///< Cosine of incidence for a beam at right angles to the axis.
  double share{};   ///< Share of the cylinder's projected width.
};

/// Lines that represent the lit half: 16-point Gauss-Legendre nodes (Abramowitz and Stegun 1964,
/// 25.4.30) in the angle from the middle line. The substitution u = sin(angle) makes the integrand
/// smooth: cosine = cos(angle), share = cos(angle) d(angle).
inline constexpr std::array<CylinderLine, 16> kCylinderLines = {{
    {0.99996535166491207, 0.021324752860931183},
    {0.99905268976724548, 0.04884748576618568},
    {0.99443655854508217, 0.074321523601038511},
    {0.98160452545521426, 0.096082754178599059},
    {0.95530122799744066, 0.1122406482039424},
    {0.91076118862166178, 0.12099937777171452},
    {0.84500208981660774, 0.12118714656534228},
    {0.75785614264529277, 0.11276456928702958},
    {0.65242169419386864, 0.097076538935859061},
    {0.53476300190417592, 0.076693777530832882},
    {0.41293347805725039, 0.054860367932073793},
    {0.29563417222402122, 0.034734772812151121},
    {0.19092552371499155, 0.018688432750471048},
    {0.10533722527678936, 0.0078726219457687964},
    {0.043516928531689383, 0.0021277081467395379},
    {0.0083243900478706528, 0.00017752171132057599},
}};

/// Mean effective reflectance over the projected width of a cylinder's lit half:
///
///   (1 / 2) integral of f(sin_axis sqrt(1 - u^2)) du over u in (-1, 1)
///
/// @param sin_axis Sine between beam and axis.
/// @param answer Effective reflectance f as a function of the cosine of incidence. A Lambertian
///     surface (rho cos) gives rho sin_axis pi / 4. For lobes of 0.1 rad the error is 1e-3 of the
///     mean.
template <typename Answer>
[[nodiscard]] double CylinderMean(double sin_axis, const Answer& answer) {
  double mean = 0.0;
  for (const CylinderLine& line : kCylinderLines) {
    mean += line.share * answer(sin_axis * line.cosine);
  }
  return mean;
}

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
