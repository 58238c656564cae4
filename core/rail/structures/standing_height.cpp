#include "core/rail/structures/standing_height.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <variant>
#include <vector>

#include "core/rail/base/rail_surfaces.h"
#include "core/rail/landform/ground_rise.h"
#include "core/rail/structures/crossing_road.h"
#include "core/rail/structures/structures.h"
#include "core/rail/survey/surveyed_scene.h"
#include "core/rail/track/cross_section.h"

namespace railcast {
namespace {

/// The floors of structures on which persons and things may stand, along a stretch of the line: the
/// roads of level crossings and the tops of platforms.
class Floors {
 public:
  Floors(const ChunkContext& context, const ChainageRange& range)
      : context_(&context), roads_(RoadsNear(context, range)) {
    for (const StructureSpec& structure : context.spec.structures) {
      const auto* platform = std::get_if<PlatformSpec>(&structure);
      if (platform == nullptr) continue;
      if (platform->end_s_m < range.begin_s_m || platform->begin_s_m > range.end_s_m) continue;
      platforms_.push_back(platform);
    }
  }

  /// The height of the highest floor at a place, in the world; minus infinity where there is none.
  /// `d_m` is left of the alignment.
  [[nodiscard]] double HeightAt_m(double s_m, double d_m) const {
    double height_m = -std::numeric_limits<double>::infinity();
    for (const CrossingRoad& road : roads_) {
      if (!road.Covers(s_m, d_m)) continue;
      const Vector3 world_m = context_->chunk_from_world.inverse() * road.PointAt(s_m, d_m);
      height_m = std::max(height_m, world_m.z());
    }
    for (const PlatformSpec* platform : platforms_) {
      const std::optional<double> top_m = PlatformTop_m(*context_, *platform, s_m, d_m);
      if (top_m) height_m = std::max(height_m, *top_m);
    }
    return height_m;
  }

 private:
  const ChunkContext* context_;
  std::vector<CrossingRoad> roads_;
  std::vector<const PlatformSpec*> platforms_;
};

/// Heights of the ground below points of an object.
class GroundBelow {
 public:
  GroundBelow(const ChunkContext& context, const StandingPlace& place)
      : context_(context),
        place_(place),
        turn_(place.heading_rad),
        reach_m_(place.area_m.min().norm() + place.area_m.max().norm()),
        world_from_chunk_(context.chunk_from_world.inverse()),
        floors_(context, {place.s_m - reach_m_, place.s_m + reach_m_}),
        rise_(context) {}

  /// @param point_m In the object's frame.
  double At_m(const Eigen::Vector2d& point_m) {
    const Eigen::Vector2d offset_m = turn_ * point_m;
    const double s_m = place_.s_m + offset_m.x();
    // Posing a person consists of little else, and along the line two corners share a section.
    if (!section_ || s_m != section_s_m_) section_.emplace(context_, s_m);
    section_s_m_ = s_m;
    return SurfaceHeight_m(s_m, place_.d_m + offset_m.y());
  }

 private:
  [[nodiscard]] double SurfaceHeight_m(double s_m, double d_m) const {
    if (context_.survey != nullptr) {
      const Vector3 place_m = context_.alignment.WorldFromTrack(s_m, d_m).translation();
      if (const auto ground_m = context_.survey->GroundHeight_m(place_m.head<2>())) {
        return std::max(*ground_m, floors_.HeightAt_m(s_m, d_m));
      }
    }
    Vector3 surface = rise_.PointAt(*section_, s_m, d_m);
    const double ballast_m = section_->BallastHeight_m(d_m);
    if (std::isfinite(ballast_m)) {
      const Vector3 ballast = section_->PointAt(d_m, ballast_m);
      if (ballast.z() > surface.z()) surface = ballast;
    }
    return std::max((world_from_chunk_ * surface).z(), floors_.HeightAt_m(s_m, d_m));
  }

  const ChunkContext& context_;
  const StandingPlace& place_;
  Eigen::Rotation2Dd turn_;
  double reach_m_;
  Transform world_from_chunk_;
  Floors floors_;
  GroundRise rise_;
  std::optional<CrossSection> section_;
  double section_s_m_ = 0.0;
};

constexpr std::array kCorners = {Eigen::AlignedBox2d::BottomLeft, Eigen::AlignedBox2d::TopLeft,
                                 Eigen::AlignedBox2d::BottomRight, Eigen::AlignedBox2d::TopRight};

}  // namespace

Transform AtTopOfRail(const StructureTrack& track, const LinesidePlace& place) {
  Transform pose = track.Upright(place.s_m);
  pose.translation() = pose * Vector3(0.0, place.d_m, 0.0);
  return pose * Eigen::AngleAxisd(place.yaw_rad, Vector3::UnitZ());
}

Transform OnGround(const ChunkContext& context,
                   const StructureTrack& track,
                   const LinesidePlace& place,
                   const Model& model) {
  const Eigen::AlignedBox3d bounds_m = model.Bounds();
  const StandingPlace standing{.s_m = place.s_m,
                               .d_m = track.offset_m(place.s_m) + place.d_m,
                               .heading_rad = place.yaw_rad,
                               .area_m = {bounds_m.min().head<2>(), bounds_m.max().head<2>()}};
  Transform pose = AtTopOfRail(track, place);
  // A chunk's frame is turned about the vertical only.
  pose.translation().z() =
      StandingHeight_m(context, standing) + context.chunk_from_world.translation().z();
  return pose;
}

double StandingHeight_m(const ChunkContext& context, const StandingPlace& place) {
  GroundBelow ground(context, place);
  double lowest_m = ground.At_m(place.area_m.center());
  for (const auto corner : kCorners) {
    lowest_m = std::min(lowest_m, ground.At_m(place.area_m.corner(corner)));
  }
  return lowest_m;
}

SlopeBelow SlopeBelowObject(const ChunkContext& context, const StandingPlace& place) {
  GroundBelow ground(context, place);
  const Eigen::Vector2d middle_m = place.area_m.center();
  // Without a width there is no slope across it.
  constexpr double kLeastSize_m = 1e-6;
  const Eigen::Vector2d sizes_m = place.area_m.sizes().cwiseMax(kLeastSize_m);
  std::array<double, kCorners.size()> heights_m{};
  double mean_m = 0.0;
  // For the corners of a rectangle, the least-squares slopes are these weighted sums.
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i < kCorners.size(); ++i) {
    const Eigen::Vector2d corner_m = place.area_m.corner(kCorners[i]);
    heights_m[i] = ground.At_m(corner_m);
    mean_m += heights_m[i] / kCorners.size();
    slope += heights_m[i] * (corner_m - middle_m).cwiseQuotient(sizes_m.cwiseProduct(sizes_m));
  }
  const auto plane_m = [&](const Eigen::Vector2d& point_m) {
    return mean_m + slope.dot(point_m - middle_m);
  };
  double lowest_m = std::min(0.0, ground.At_m(middle_m) - mean_m);
  for (std::size_t i = 0; i < kCorners.size(); ++i) {
    lowest_m = std::min(lowest_m, heights_m[i] - plane_m(place.area_m.corner(kCorners[i])));
  }
  return {plane_m(Eigen::Vector2d::Zero()) + lowest_m,
          Vector3(-slope.x(), -slope.y(), 1.0).normalized()};
}

}  // namespace railcast
