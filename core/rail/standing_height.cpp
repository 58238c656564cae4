#include "core/rail/standing_height.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/rail/land/land.h"
#include "core/rail/structures/floors.h"
#include "core/rail/track/cross_section.h"

namespace railcast {
namespace {

double SurfaceHeight_m(const ChunkContext& context,
                       const CrossSection& section,
                       const Floors& floors,
                       double s_m,
                       double d_m) {
  Vector3 surface = GroundPoint(context, section, s_m, d_m);
  const double ballast_m = section.BallastHeight_m(d_m);
  if (std::isfinite(ballast_m)) {
    const Vector3 ballast = section.PointAt(d_m, ballast_m);
    if (ballast.z() > surface.z()) surface = ballast;
  }
  const double height_m = (context.chunk_from_world.inverse() * surface).z();
  return std::max(height_m, floors.HeightAt_m(s_m, d_m));
}

}  // namespace

double StandingHeight_m(const ChunkContext& context, const StandingPlace& place) {
  const Eigen::Rotation2Dd turn(place.heading_rad);
  double lowest_m = std::numeric_limits<double>::infinity();
  const double reach_m = place.area_m.min().norm() + place.area_m.max().norm();
  const Floors floors(context, {place.s_m - reach_m, place.s_m + reach_m});
  // Posing a person consists of little else, and along the line two corners share a section.
  std::optional<CrossSection> section;
  double section_s_m = 0.0;
  const auto stand_at = [&](const Eigen::Vector2d& point_m) {
    const Eigen::Vector2d offset_m = turn * point_m;
    const double s_m = place.s_m + offset_m.x();
    if (!section || s_m != section_s_m) section.emplace(context, s_m);
    section_s_m = s_m;
    lowest_m = std::min(lowest_m,
                        SurfaceHeight_m(context, *section, floors, s_m, place.d_m + offset_m.y()));
  };
  stand_at(place.area_m.center());
  for (const auto corner : {Eigen::AlignedBox2d::BottomLeft, Eigen::AlignedBox2d::TopLeft,
                            Eigen::AlignedBox2d::BottomRight, Eigen::AlignedBox2d::TopRight}) {
    stand_at(place.area_m.corner(corner));
  }
  return lowest_m;
}

}  // namespace railcast
