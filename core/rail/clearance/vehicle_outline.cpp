#include "core/rail/clearance/vehicle_outline.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

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

}  // namespace railcast
