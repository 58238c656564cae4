#pragma once

#include "core/rail/line/alignment_spec.h"
#include "core/scenario/json_rules.h"

namespace railcast {

template <>
inline constexpr const char* kTypeName<AlignmentSectionsSpec> = "sections";
template <>
inline constexpr const char* kTypeName<AlignmentElementsSpec> = "elements";
template <>
inline constexpr const char* kTypeName<AlignmentSplineSpec> = "spline";

/// Longer lines are taken for a slip; shorter elements would vanish against a long line's chainage.
[[nodiscard]] inline Limits LengthOfLine() {
  return Within(1e-3, 1e7);
}

template <class Archive>
void Describe(Archive& a, CurvatureSection& s) {
  a.Required("s_m", s.s_m, "Chainage of the start.", NonNegative());
  a.Optional("radius_start_m", s.radius_start_m,
             "Left positive, right negative; absent = straight.");
  a.Optional("radius_end_m", s.radius_end_m, "Left positive, right negative; absent = straight.");
  a.Ensure({"radius_start_m"}, s.radius_start_m != 0.0, "must not be 0");
  a.Ensure({"radius_end_m"}, s.radius_end_m != 0.0, "must not be 0");
}

template <class Archive>
void Describe(Archive& a, AlignmentSectionsSpec& s) {
  a.Required("length_m", s.length_m, "Chainage of the end.", LengthOfLine());
  a.Required("sections", s.sections, "The first at chainage 0.", NonEmptyList());
}

template <class Archive>
void Describe(Archive& a, AlignmentElement& s) {
  a.Required("type", s.type, "A clothoid leads from the curvature before it to the one after it.",
             OneOf({"straight", "clothoid", "arc"}));
  a.Required("length_m", s.length_m, "Length.", LengthOfLine());
  a.Optional("radius_m", s.radius_m, "Of an arc only: left positive, right negative.");
  a.Ensure({"radius_m"}, s.radius_m != 0.0, "must not be 0");
  a.Ensure({"radius_m", "type"}, s.type != "arc" || s.radius_m.has_value(),
           "must be given for an arc");
  a.Ensure({"radius_m", "type"}, s.type == "arc" || !s.radius_m, "must be given for an arc only");
}

template <class Archive>
void Describe(Archive& a, AlignmentElementsSpec& s) {
  a.Required("elements", s.elements, "One after the other from chainage 0.", NonEmptyList());
}

template <class Archive>
void Describe(Archive& a, AlignmentSplineSpec& s) {
  a.Required("points_m", s.points_m, "Plan points (x, y), joined with continuous curvature.",
             AtLeastElements{2});
}

template <class Archive>
void Describe(Archive& a, ChainageValue& s) {
  a.Required("s_m", s.s_m, "From this chainage on ...", NonNegative());
  a.Required("value", s.value, "... this value.");
}

template <class Archive>
void Describe(Archive& a, AlignmentSpec& s) {
  a.Required("course", s.course, "The line in plan.");
  a.Optional("attribution", s.attribution, "Where the figures come from.");
  a.Optional("origin_m", s.origin_m, "World position of chainage 0.", Within(-1e8, 1e8));
  a.Optional("heading_deg", s.heading_deg, "At chainage 0, counterclockwise from east.");
  a.Optional("gradients_permil", s.gradients_permil, "By chainage; none = level.");
  a.Optional("speed_limits_kmph", s.speed_limits_kmph, "By chainage; none = no cant.");
  a.Optional("curvature_smoothing_m", s.curvature_smoothing_m,
             "Jumps of curvature become clothoids of at most this length.", Positive());
  a.Optional("gradient_smoothing_m", s.gradient_smoothing_m,
             "Jumps of gradient become parabolas of at most this length.", Positive());
  a.Optional("cant_deficiency_mm", s.cant_deficiency_mm, "Cant = 11.8 v^2 / R less this.",
             NonNegative());
  a.Optional("cant_max_mm", s.cant_max_mm, "Greatest cant.", Within(0, 300));
  a.Optional("cant_ramp_m", s.cant_ramp_m, "Length that cant is averaged over.", Positive());
}

}  // namespace railcast
