#pragma once

#include <array>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace railcast {

/// A piece of a line whose curvature changes linearly, from `s_m` to the next section's.
/// Radii: left positive, right negative, absent = straight.
struct CurvatureSection {
  double s_m{};
  std::optional<double> radius_start_m;
  std::optional<double> radius_end_m;

  bool operator==(const CurvatureSection&) const = default;
};

/// A surveyed line: curvature by chainage, as alignment files publish it.
struct AlignmentSectionsSpec {
  double length_m{};                       ///< Chainage of the end; after the last section's start.
  std::vector<CurvatureSection> sections;  ///< The first at chainage 0.

  bool operator==(const AlignmentSectionsSpec&) const = default;
};

/// One element of a line. A clothoid leads from the curvature before it to the one after it.
struct AlignmentElement {
  std::string type;                ///< "straight", "clothoid" or "arc".
  double length_m{};               ///< > 0.
  std::optional<double> radius_m;  ///< Of an arc only: left positive, right negative.

  bool operator==(const AlignmentElement&) const = default;
};

struct AlignmentElementsSpec {
  std::vector<AlignmentElement> elements;

  bool operator==(const AlignmentElementsSpec&) const = default;
};

/// Plan points (x, y) joined by a natural cubic spline, whose curvature is continuous. The points
/// are in a plan frame of their own: the alignment's origin_m and heading_deg say where its origin
/// lies and how its x axis points, so with both at their defaults the points are world coordinates.
struct AlignmentSplineSpec {
  std::vector<std::array<double, 2>> points_m;

  bool operator==(const AlignmentSplineSpec&) const = default;
};

/// From chainage `s_m` on, `value`.
struct ChainageValue {
  double s_m{};
  double value{};

  bool operator==(const ChainageValue&) const = default;
};

/// The axis of the line. Chainage is measured in plan.
struct AlignmentSpec {
  std::variant<AlignmentSectionsSpec, AlignmentElementsSpec, AlignmentSplineSpec> course;
  std::string attribution;  ///< Where the figures come from; carried along.

  std::array<double, 3> origin_m{0, 0, 0};  ///< World position of chainage 0 (of a spline: of its
                                            ///< points' origin; its height is chainage 0's).
  double heading_deg = 0.0;  ///< At chainage 0, counterclockwise from east (of a spline: of its
                             ///< points' x axis).

  std::vector<ChainageValue> gradients_permil;   ///< Empty = level.
  std::vector<ChainageValue> speed_limits_kmph;  ///< Empty = no cant.

  /// Jumps of curvature become clothoids, jumps of gradient parabolas of at most this length.
  double curvature_smoothing_m = 20.0;
  double gradient_smoothing_m = 40.0;

  /// Cant by rule: clamp(11.8 v^2 / R - deficiency, 0, max), averaged over the ramp length.
  double cant_deficiency_mm = 60.0;
  double cant_max_mm = 150.0;
  double cant_ramp_m = 60.0;

  bool operator==(const AlignmentSpec&) const = default;
};

}  // namespace railcast
