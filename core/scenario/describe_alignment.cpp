#include "core/scenario/descriptions.h"

#include <cmath>
#include <cstddef>
#include <string>

#include "core/base/text.h"
#include "core/scenario/shared_keys.h"
#include "railcast/alignment.h"

namespace railcast {

namespace {

/// Longer lines are probably typing errors; a spline of this length takes 240 MB and a few seconds.
constexpr double kLongestLine_m = 1e7;

[[nodiscard]] std::string LongestLineRule(double length_m) {
  return "must make a line of at most 10000000 m, not of " + NumberText(length_m) + " m";
}

/// Shorter elements would be lost in the rounding of a long line's chainage.
[[nodiscard]] Limits LengthOfLine() {
  return Within(1e-3, kLongestLine_m);
}

/// An arc of the longest radius is practically straight: it deviates by 1 um in 1 km.
[[nodiscard]] Limits RadiusLimits() {
  return Within(-1e12, 1e12);
}
/// From a negligible smoothing length to one that flattens a whole valley.
[[nodiscard]] Limits SmoothingLimits() {
  return Within(1e-3, 1e4);
}

}  // namespace

void Describe(Archive& a, CurvatureSection& s) {
  a.Required("s_m", s.s_m, "Chainage of the start.", ChainageLimits());
  a.Optional("radius_start_m", s.radius_start_m,
             "Left positive, right negative; absent = straight.", RadiusLimits());
  a.Optional("radius_end_m", s.radius_end_m, "Left positive, right negative; absent = straight.",
             RadiusLimits());
  a.Ensure({"radius_start_m"}, s.radius_start_m != 0.0, "must not be 0");
  a.Ensure({"radius_end_m"}, s.radius_end_m != 0.0, "must not be 0");
}

void Describe(Archive& a, AlignmentSectionsSpec& s) {
  a.Required("length_m", s.length_m, "Chainage of the end.", LengthOfLine());
  a.Required("sections", s.sections, "The sections; the first one starts at chainage 0.",
             NonEmptyList());
}

void Describe(Archive& a, AlignmentElement& s) {
  a.Required("type", s.type, "A clothoid leads from the curvature before it to the one after it.");
  a.Required("length_m", s.length_m, "Length.", LengthOfLine());
  a.Optional("radius_m", s.radius_m,
             "Radius of an arc: left positive, right negative. Only for arcs.", RadiusLimits());
  a.Ensure({"radius_m"}, s.radius_m != 0.0, "must not be 0");
  a.Ensure({"radius_m", "type"}, s.type != ElementType::kArc || s.radius_m.has_value(),
           "must be given for an arc");
  a.Ensure({"radius_m", "type"}, s.type == ElementType::kArc || !s.radius_m,
           "must be given for an arc only");
}

void Describe(Archive& a, AlignmentElementsSpec& s) {
  a.Required("elements", s.elements, "One after the other from chainage 0.", NonEmptyList());
  double length_m = 0.0;
  for (const AlignmentElement& element : s.elements) length_m += element.length_m;
  a.Ensure({"elements"}, length_m <= kLongestLine_m, LongestLineRule(length_m));
}

void Describe(Archive& a, AlignmentSplineSpec& s) {
  a.Required("points_m", s.points_m, "Plan points (x, y), joined with continuous curvature.",
             EachNumber{.limits = CoordinateLimits(), .at_least = 2});
  double length_m = 0.0;
  for (std::size_t i = 1; i < s.points_m.size(); ++i) {
    length_m += std::hypot(s.points_m[i][0] - s.points_m[i - 1][0],
                           s.points_m[i][1] - s.points_m[i - 1][1]);
  }
  a.Ensure({"points_m"}, length_m <= kLongestLine_m, LongestLineRule(length_m));
}

void Describe(Archive& a, ChainageValue& s) {
  a.Required("s_m", s.s_m, "Chainage of the value.", ChainageLimits());
  a.Required("value", s.value,
             "Value from this chainage on; in lists that are linear between their entries, the "
             "value at this chainage.");
}

void Describe(Archive& a, MapSpec& s) {
  a.Optional("origin_m", s.origin_m,
             "Easting and northing in the map's projection of the world's origin.",
             CoordinateLimits());
  a.Required("longitude_deg", s.longitude_deg,
             "Longitude (WGS 84) of the middle of the transverse Mercator projection with scale 1 "
             "that turns degrees into metres.",
             Within(-180, 180));
  a.Required("latitude_deg", s.latitude_deg, "Latitude of the middle of the projection.",
             Within(-90, 90));
  a.Optional("coefficients_m", s.coefficients_m,
             "Empty if that is the map's projection. Otherwise the world's x and y are polynomials "
             "of its easting e and northing n in 100 km: the coefficients (x, y) of 1, e, n, e^2, "
             "e n, n^2, e^3 and so on.",
             EachNumber{.limits = CoordinateLimits()});
}

void Describe(Archive& a, AlignmentSpec& s) {
  a.Required("course", s.course, "The line in plan.");
  a.Optional("attribution", s.attribution, "Where the figures come from.");
  a.Optional("origin_m", s.origin_m, "World position of chainage 0.", CoordinateLimits());
  a.Optional("heading_deg", s.heading_deg, "Heading at chainage 0, counterclockwise from east.",
             HeadingLimits());
  // The steepest railway, on the Pilatus, has 480 permil.
  a.Optional("gradients_permil", s.gradients_permil, "Gradients by chainage; none = level.",
             EachValue(Within(-500, 500)));
  a.Optional("speed_limits_kmph", s.speed_limits_kmph,
             "Speed limits by chainage, from which cant follows; none = no cant by the rule.",
             EachValue(PositiveUpTo(1000)));
  a.Optional("cants_mm", s.cants_mm,
             "Surveyed cant by chainage, linear between the entries: the right above the left "
             "rail. It takes the place of the rule.",
             EachValue(Within(-300, 300)));
  a.Optional("gauge_mm", s.gauge_mm, "Gauge of all tracks.",
             Within(kNarrowestGauge_mm, kWidestGauge_mm));
  a.Optional("curvature_smoothing_m", s.curvature_smoothing_m,
             "Jumps of curvature become clothoids of at most this length.", SmoothingLimits());
  a.Optional("gradient_smoothing_m", s.gradient_smoothing_m,
             "Jumps of gradient become parabolas of at most this length.", SmoothingLimits());
  a.Optional("cant_deficiency_mm", s.cant_deficiency_mm,
             "Cant deficiency: cant = 11.8 v^2 / R minus this.", Within(0, 1000));
  a.Optional("cant_max_mm", s.cant_max_mm, "Greatest cant.", Within(0, 300));
  a.Optional("cant_ramp_m", s.cant_ramp_m, "Length over which cant is averaged.",
             SmoothingLimits());
  a.Optional("map", s.map, "Where on the Earth the world lies; absent = unknown.");
}

}  // namespace railcast
