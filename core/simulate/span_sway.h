#pragma once

#include "core/simulate/wind.h"
#include "railcast/scene.h"

namespace railcast {

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

}  // namespace railcast
