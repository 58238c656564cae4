#include "core/rail/line/rail_section.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace railcast {
namespace {

constexpr double kRunningBandHalfWidth_mm = 26.0;

/// Right half of the 60E1 section, from the crown downwards (docs/physics.md 7.1).
constexpr std::array<std::array<double, 2>, 18> kHalfSection_mm{{{0, 0},
                                                                 {10, -0.2},
                                                                 {20.5, -1.1},
                                                                 {26, -2.2},
                                                                 {33, -7.6},
                                                                 {36, -14.1},
                                                                 {37.15, -37.5},
                                                                 {20, -43.7},
                                                                 {12, -50},
                                                                 {9.5, -58},
                                                                 {8.25, -80},
                                                                 {8.25, -110},
                                                                 {9.5, -132},
                                                                 {14, -143},
                                                                 {24, -150.5},
                                                                 {38, -155.5},
                                                                 {75, -160.5},
                                                                 {75, -172}}};

/// Tilts an upright section so that its top leans towards the middle of the track (smaller y).
Eigen::Vector2d Inclined(const Eigen::Vector2d& point) {
  const double angle_rad = std::atan(kRailInclination);
  return {point.x() * std::cos(angle_rad) - point.y() * std::sin(angle_rad),
          point.x() * std::sin(angle_rad) + point.y() * std::cos(angle_rad)};
}

/// Smallest y at which an outline crosses a height: its inner side.
double InnerSideAt(const std::vector<Eigen::Vector2d>& outline_m, double z_m) {
  double inner_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + 1 < outline_m.size(); ++i) {
    const Eigen::Vector2d& a = outline_m[i];
    const Eigen::Vector2d& b = outline_m[i + 1];
    if (std::min(a.y(), b.y()) > z_m || std::max(a.y(), b.y()) < z_m || a.y() == b.y()) continue;
    inner_m = std::min(inner_m, std::lerp(a.x(), b.x(), (z_m - a.y()) / (b.y() - a.y())));
  }
  return inner_m;
}

std::vector<Eigen::Vector2d> InclinedOutline() {
  std::vector<Eigen::Vector2d> outline_m;
  for (std::size_t i = kHalfSection_mm.size() - 1; i > 0; --i) {
    outline_m.push_back(1e-3 * Inclined({-kHalfSection_mm[i][0], kHalfSection_mm[i][1]}));
  }
  for (const auto& [x_mm, z_mm] : kHalfSection_mm) {
    outline_m.push_back(1e-3 * Inclined({x_mm, z_mm}));
  }
  return outline_m;
}

/// Offset from the tilted section about its own crown to its position in the left half of the
/// track.
Eigen::Vector2d PlaceOfCrown(const std::vector<Eigen::Vector2d>& outline_m) {
  double top_m = -std::numeric_limits<double>::infinity();
  for (const Eigen::Vector2d& point : outline_m) top_m = std::max(top_m, point.y());
  return {0.5 * kGauge_m - InnerSideAt(outline_m, top_m - kGaugeDepth_m), -top_m};
}

}  // namespace

RailSection MakeRailSection(bool left) {
  RailSection section{.outline_m = InclinedOutline(), .head_first = 0, .head_last = 0};
  const Eigen::Vector2d place_m = PlaceOfCrown(section.outline_m);
  for (Eigen::Vector2d& point : section.outline_m) point += place_m;
  const auto band_end =
      std::find_if(kHalfSection_mm.begin(), kHalfSection_mm.end(),
                   [](const auto& point) { return point[0] >= kRunningBandHalfWidth_mm; });
  const auto half_band = static_cast<std::size_t>(band_end - kHalfSection_mm.begin());
  section.head_first = kHalfSection_mm.size() - 1 - half_band;
  section.head_last = kHalfSection_mm.size() - 1 + half_band;
  if (!left) {
    for (Eigen::Vector2d& point : section.outline_m) point.x() = -point.x();
    std::reverse(section.outline_m.begin(), section.outline_m.end());
  }
  return section;
}

Eigen::Vector2d RailFootMiddle_m() {
  const RailSection section = MakeRailSection(true);
  return 0.5 * (section.outline_m.front() + section.outline_m.back());
}

}  // namespace railcast
