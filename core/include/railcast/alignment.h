#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "railcast/enum_names.h"
#include "railcast/transform.h"

namespace railcast {

/// One section of a surveyed line. Its curvature changes linearly from `s_m` to the start of the
/// next section (or to the end of the line). Radii are left positive, right negative; absent =
/// straight.
struct CurvatureSection {
  double s_m{};
  std::optional<double> radius_start_m;
  std::optional<double> radius_end_m;

  bool operator==(const CurvatureSection&) const = default;
};

/// A surveyed line given as curvature over chainage, as alignment files publish it.
struct AlignmentSectionsSpec {
  double length_m{};  ///< Chainage of the end; must exceed the start of the last section.
  std::vector<CurvatureSection> sections;  ///< In order of chainage; the first starts at 0.

  bool operator==(const AlignmentSectionsSpec&) const = default;
};

/// Shape of an element of a line.
enum class ElementType {
  kStraight,
  kClothoid,  ///< Joins the curvatures of the elements before and after it.
  kArc,
};
template <>
inline constexpr auto kEnumNames<ElementType> =
    std::to_array<EnumName<ElementType>>({{ElementType::kStraight, "straight"},
                                          {ElementType::kClothoid, "clothoid"},
                                          {ElementType::kArc, "arc"}});

/// One element of a line.
struct AlignmentElement {
  ElementType type{};
  double length_m{};               ///< > 0.
  std::optional<double> radius_m;  ///< Arcs only: left positive, right negative.

  bool operator==(const AlignmentElement&) const = default;
};

/// A line given by its elements, which follow one another from chainage 0.
struct AlignmentElementsSpec {
  std::vector<AlignmentElement> elements;

  bool operator==(const AlignmentElementsSpec&) const = default;
};

/// Plan points (x, y) joined by a natural cubic spline, whose curvature is continuous.
///
/// The points have a plan frame of their own: AlignmentSpec::origin_m places its origin in the
/// world and AlignmentSpec::heading_deg turns its x axis. With both at their defaults, the points
/// are world coordinates.
struct AlignmentSplineSpec {
  std::vector<std::array<double, 2>> points_m;

  bool operator==(const AlignmentSplineSpec&) const = default;
};

/// A value that holds from chainage `s_m` up to the next entry.
struct ChainageValue {
  double s_m{};
  double value{};

  bool operator==(const ChainageValue&) const = default;
};

/// Where a world lies on the Earth: its x axis points to the east of a map's projection, its y axis
/// to the north.
struct MapSpec {
  /// Easting and northing in the map's projection of the world's origin.
  std::array<double, 2> origin_m{0, 0};
  /// Central point (WGS 84) of the transverse Mercator projection with scale 1 that turns
  /// longitudes and latitudes into metres (core/rail/line/map_place.h).
  double longitude_deg{};
  double latitude_deg{};
  /// Empty if that transverse Mercator is the map's projection. Otherwise the world's x and y are
  /// polynomials of its easting e and northing n in units of kUnit_m, with the coefficients (x, y)
  /// of 1, e, n, e^2, e n, n^2, e^3 and so on.
  std::vector<std::array<double, 2>> coefficients_m;
  static constexpr double kUnit_m = 1e5;

  bool operator==(const MapSpec&) const = default;
};

/// Gauges: the standard one, which all turnouts and wagons have, and the limits of what a line may
/// have, from field railways to broader than India's 1676 mm.
inline constexpr double kStandardGauge_mm = 1435.0;
inline constexpr double kNarrowestGauge_mm = 600.0;
inline constexpr double kWidestGauge_mm = 1700.0;

/// Geometry of the line's axis: plan, gradients, and the speed limits that determine the cant.
/// Chainage is measured in plan.
struct AlignmentSpec {
  std::variant<AlignmentSectionsSpec, AlignmentElementsSpec, AlignmentSplineSpec> course;
  std::string attribution;  ///< Source of the survey data; stored with the scenario, not evaluated.

  /// World position of chainage 0. For a spline: of the origin of its points, with z the height of
  /// chainage 0.
  std::array<double, 3> origin_m{0, 0, 0};
  /// Heading at chainage 0, counterclockwise from east. For a spline: heading of its points' x
  /// axis.
  double heading_deg = 0.0;

  std::vector<ChainageValue> gradients_permil;   ///< Positive = rising; empty = level.
  std::vector<ChainageValue> speed_limits_kmph;  ///< Empty = no cant by the rule.
  /// Surveyed cant, linear between the entries: the height of the right above the left rail. It
  /// takes the place of the rule; empty = by the rule.
  std::vector<ChainageValue> cants_mm;

  double gauge_mm = kStandardGauge_mm;  ///< Between the running edges of the rails, on all tracks.

  /// Length (at most) of the clothoids that replace jumps in curvature.
  double curvature_smoothing_m = 20.0;
  /// Length (at most) of the parabolas that replace jumps in gradient.
  double gradient_smoothing_m = 40.0;

  /// Cant that was not surveyed follows the rule clamp(11.8 v^2 / R - deficiency, 0, max) in mm, v
  /// in km/h and R in m, averaged over the ramp length.
  double cant_deficiency_mm = 60.0;
  double cant_max_mm = 150.0;
  double cant_ramp_m = 60.0;

  std::optional<MapSpec> map{};  ///< Absent: it is not known where on the Earth the world lies.

  bool operator==(const AlignmentSpec&) const = default;
};

/// The axis of the line at one chainage.
struct AxisPoint {
  Vector3 position_m;    ///< In the world, on the axis at top of rail.
  double heading_rad{};  ///< Counterclockwise from east; continuous, so it may exceed a full turn.
  double gradient{};     ///< Rise per metre of chainage.
  double curvature_per_m{};  ///< Left positive.
  /// Roll about the axis as in RotationFromYawPitchRoll: positive raises the left side. The track
  /// leans into the curve, so the cant is negative in left curves.
  double cant_rad{};
};

/// A jump in the given curvature or gradient that was smoothed.
struct SmoothedJump {
  std::string quantity;  ///< "curvature" (1/m) or "gradient" (permil).
  /// Chainage of the middle of the smoothed stretch.
  double s_m{};
  double before{};
  double after{};
  double length_m{};  ///< Length over which the quantity now changes linearly.
};

/// The line's axis: curvature, gradient and cant as functions of chainage, integrated to positions
/// in double precision. Immutable, thread-safe, cheap to copy.
///
/// Chainage is arc length in plan. Sections and elements are integrated from their curvature
/// (PlanCourse), a spline is evaluated directly (PlanSpline). Heights are the exact integral of the
/// gradient.
///
///     const Alignment alignment(spec);
///     const Transform world_from_track = alignment.WorldFromTrack(1250.0);  // Axis, top of rail.
class Alignment {
 public:
  /// @throws InputError if the elements or points do not define a line, or if a spline has a cusp.
  ///   Each line reads "/pointer: rule (got value)", with the pointer relative to the alignment's
  ///   JSON object.
  explicit Alignment(const AlignmentSpec& spec);

  [[nodiscard]] double length_m() const;
  /// The axis at chainage `s_m`. Beyond either end, the line continues straight and level with the
  /// heading and cant of that end.
  [[nodiscard]] AxisPoint At(double s_m) const;
  /// Speed limit at chainage `s_m`; infinite where the spec has none.
  [[nodiscard]] double SpeedLimitMps(double s_m) const;
  /// Smallest radius of curvature after smoothing; infinite if the whole line is straight.
  [[nodiscard]] double tightest_radius_m() const;
  /// All smoothed jumps: first those in curvature, then those in gradient, each in order of
  /// chainage.
  [[nodiscard]] const std::vector<SmoothedJump>& smoothed_jumps() const;

  /// The track frame at chainage `s_m`: x along the axis, y left, z up, with gradient and cant
  /// applied.
  ///
  /// The origin is `h_m` above top of rail and `d_m` left of the axis, measured horizontally.
  /// Parallel tracks therefore lie at the same height and each is canted about its own axis, as on
  /// a real double-track line.
  [[nodiscard]] Transform WorldFromTrack(double s_m, double d_m = 0.0, double h_m = 0.0) const;

 private:
  struct Parts;
  std::shared_ptr<const Parts> parts_;
};

}  // namespace railcast
