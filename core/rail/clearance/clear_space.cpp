#include "core/rail/clearance/clear_space.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/rail/line/alignment_course.h"

namespace railcast {
namespace {

constexpr double kWagonHalfWidth_m = 1.575;
constexpr double kWagonHeight_m = 4.28;
// Pairs of maximum height of the contact wire and half width.
constexpr std::array<std::pair<double, double>, 4> kPantographHalfWidths_m = {
    {{5.3, 1.43}, {5.5, 1.44}, {5.9, 1.47}, {6.5, 1.51}}};

using Corner = Eigen::Vector2d;
using Edges = Eigen::Matrix<double, 2, 3>;

/// Extent of a box from its centre along a direction in the cross-section.
double ReachOf(const Edges& half_edges_m, const Corner& direction) {
  return (direction.transpose() * half_edges_m).cwiseAbs().sum();
}

// Separating axis theorem: the projection of a box onto the cross-section is bounded by lines
// parallel to the projections of its edges.
bool IsInside(const GaugePart& part, const Corner& center_m, const Edges& half_edges_m) {
  const Corner middle_m(0.0, 0.5 * (part.bottom_m + part.top_m));
  const Corner half_m(part.half_width_m, 0.5 * (part.top_m - part.bottom_m));
  const auto is_apart_along = [&](const Corner& direction) {
    const double apart_m = std::abs(direction.dot(center_m - middle_m));
    return apart_m >= ReachOf(half_edges_m, direction) + direction.cwiseAbs().dot(half_m);
  };
  if (is_apart_along(Corner::UnitX()) || is_apart_along(Corner::UnitY())) return false;
  for (int i = 0; i < 3; ++i) {
    const Corner edge = half_edges_m.col(i);
    // An edge along the track projects to a point.
    constexpr double kPoint_m = 1e-9;
    if (edge.norm() < kPoint_m) continue;
    if (is_apart_along(Corner(-edge.y(), edge.x()).normalized())) return false;
  }
  return true;
}

}  // namespace

std::optional<double> PantographHalfWidth_m(double contact_height_m) {
  for (const auto& [highest_m, half_width_m] : kPantographHalfWidths_m) {
    if (contact_height_m <= highest_m) return half_width_m;
  }
  return std::nullopt;
}

std::vector<GaugePart> VehicleOutline(std::optional<double> contact_height_m) {
  std::vector<GaugePart> parts = {{kWagonHalfWidth_m, 0.0, kWagonHeight_m}};
  const std::optional<double> half_width_m =
      contact_height_m ? PantographHalfWidth_m(*contact_height_m) : std::nullopt;
  if (half_width_m) parts.push_back({*half_width_m, kWagonHeight_m, kPantographTop_m});
  return parts;
}

std::optional<double> ContactHeightOver_m(const TrackSpec& track, const CatenarySpec& catenary) {
  if (!catenary.enabled || !track.electrified) return std::nullopt;
  return catenary.contact_height_m;
}

bool IsInside(const std::vector<GaugePart>& outline, double lateral_m, double height_m) {
  return std::ranges::any_of(outline, [&](const GaugePart& part) {
    return std::abs(lateral_m) < part.half_width_m && height_m > part.bottom_m &&
           height_m < part.top_m;
  });
}

GaugeClearance ClearanceOf(const std::vector<GaugePart>& gauge,
                           const Transform& track_from_box,
                           const Vector3& size_m) {
  const Corner center_m = track_from_box.translation().tail<2>();
  const Edges half_edges_m = track_from_box.linear().bottomRows<2>() * (0.5 * size_m).asDiagonal();
  const double from_axis_m =
      std::abs(center_m.x()) - ReachOf(half_edges_m, Eigen::Vector2d::UnitX());
  return {.is_inside = std::ranges::any_of(
              gauge, [&](const GaugePart& part) { return IsInside(part, center_m, half_edges_m); }),
          .from_axis_m = std::max(0.0, from_axis_m)};
}

double CurveWidening_m(double curvature_per_m, double side) {
  constexpr double kTight_m = 250.0;
  constexpr double kFormulasEnd_m = 150.0;
  constexpr double kBend_m = 120.0;  // Where the table bends.
  constexpr double kAtTight_m = 3.75 / kTight_m;
  struct Side {
    double per_bend_m2, less_m, at_bend_m, at_end_m;
  };
  constexpr Side kInside{50.0, 0.185, 0.335 + kAtTight_m, 0.530 + kAtTight_m};
  constexpr Side kOutside{60.0, 0.225, 0.365 + kAtTight_m, 0.570 + kAtTight_m};
  const double radius_m = 1.0 / std::abs(curvature_per_m);  // Infinite on the straight.
  if (radius_m >= kTight_m) return 3.75 / radius_m;
  const Side& of = curvature_per_m * side > 0.0 ? kInside : kOutside;
  const auto by_formula = [&](double at_m) { return of.per_bend_m2 / at_m - of.less_m; };
  const auto between = [&](double from_m, double from, double to_m, double to) {
    return std::lerp(from, to, (radius_m - from_m) / (to_m - from_m));
  };
  if (radius_m >= kFormulasEnd_m) return by_formula(radius_m);
  if (radius_m >= kBend_m) {
    return between(kFormulasEnd_m, by_formula(kFormulasEnd_m), kBend_m, of.at_bend_m);
  }
  if (radius_m >= kLeastWidenedRadius_m) {
    return between(kBend_m, of.at_bend_m, kLeastWidenedRadius_m, of.at_end_m);
  }
  return of.at_end_m * kLeastWidenedRadius_m / radius_m;
}

TrackBend BendAt(const TrackCourse& track, const Alignment& alignment, double s_m) {
  constexpr double kMetresPerMm = 1e-3;
  return {.curvature_per_m = track.CurvatureAt(alignment, s_m),
          .cant_m =
              kMetresPerMm * kStandardSpacing_mm * std::abs(std::sin(alignment.At(s_m).cant_rad))};
}

double CantWidening_m(double height_m, double cant_m) {
  constexpr double kFlexibility = 0.4;
  constexpr double kBase_m = 1.5;
  constexpr double kIncludedCant_m = 0.05;
  constexpr double kRollCentre_m = 0.5;
  return kFlexibility / kBase_m * std::max(cant_m - kIncludedCant_m, 0.0) *
         std::max(height_m - kRollCentre_m, 0.0);
}

std::vector<HalfWidth> ClearHalfWidths(const WorldSpec& world) {
  if (!world.clear_space.empty()) return world.clear_space;
  return {kClearHalfWidths.begin(), kClearHalfWidths.end()};
}

std::vector<HalfWidth> ClearSpace(std::vector<HalfWidth> rows,
                                  std::optional<double> contact_height_m,
                                  const TrackBend& bend,
                                  double side) {
  for (HalfWidth& row : rows) {
    row.half_width_m +=
        CurveWidening_m(bend.curvature_per_m, side) + CantWidening_m(row.height_m, bend.cant_m);
  }
  const std::optional<double> pantograph_m =
      contact_height_m ? PantographHalfWidth_m(*contact_height_m) : std::nullopt;
  if (!pantograph_m || rows.back().height_m >= kPantographTop_m) return rows;
  std::size_t num_wider = rows.size();
  while (num_wider > 0 && rows[num_wider - 1].half_width_m < *pantograph_m) --num_wider;
  if (num_wider < rows.size()) {
    HalfWidth& first = rows[num_wider];
    if (num_wider > 0) {
      const HalfWidth& below = rows[num_wider - 1];
      const double share =
          (below.half_width_m - *pantograph_m) / (below.half_width_m - first.half_width_m);
      first.height_m = std::lerp(below.height_m, first.height_m, share);
    }
    first.half_width_m = *pantograph_m;
    rows.resize(num_wider + 1);
  }
  const double from_m = rows.back().height_m;
  rows.push_back({from_m, *pantograph_m});
  rows.push_back({kPantographTop_m, *pantograph_m});
  return rows;
}

}  // namespace railcast
