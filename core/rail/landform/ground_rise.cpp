#include "core/rail/landform/ground_rise.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

#include "core/rail/landform/landform.h"

namespace railcast {
namespace {

/// Where the ground before a wall ends, where it counts as behind it, and where that begins: so far
/// before the wall's back. Its top is 0.4 m thick.
constexpr double kFrontEnd_m = 0.25;
constexpr double kGroundStep_m = 0.20;
constexpr double kBackBegin_m = 0.02;

/// So far below the top, the ground does not cover the coping.
constexpr double kBelowTop_m = 0.05;

constexpr double kSmoothBehind_m = 1.0;

/// Whether the ground behind the wall goes on behind another one beyond a chainage, at which the
/// wall begins or ends: the other one stands there, too, and its back is in the same line.
bool Continues(const RetainingWallSpec& wall, const RetainingWallSpec& other, double at_s_m) {
  constexpr double kSame_m = 0.01;
  const bool is_begin = at_s_m == wall.begin_s_m;
  const bool is_there =
      is_begin ? other.begin_s_m < at_s_m - kSame_m && other.end_s_m > at_s_m - kSame_m
               : other.end_s_m > at_s_m + kSame_m && other.begin_s_m < at_s_m + kSame_m;
  return &wall != &other && is_there && wall.track == other.track && wall.side == other.side &&
         std::abs(BackOf_m(wall) - BackOf_m(other)) < kFrontEnd_m;
}

/// Distance from a track's axis up to which there is no undulation.
constexpr double kLevelReach_m = 4.0;
constexpr double kFullReach_m = 30.0;  ///< Distance from which undulation has its full height.
constexpr double kLongWave_m = 30.0;
constexpr double kShortWave_m = 12.0;
constexpr double kLongWaveShare = 0.8;  ///< Share of the variance.

/// Depth below the top of the ballast over which roughness fades out.
constexpr double kSmoothBelow_m = 0.25;

/// How far beyond its chunk the ground may be asked for: plants and objects at its ends.
constexpr double kBeyondChunk_m = 100.0;

}  // namespace

RetainedGround::RetainedGround(const ChunkContext& context, double begin_s_m, double end_s_m)
    : context_(&context) {
  const auto goes_on = [&](const RetainingWallSpec& wall, double at_s_m) {
    return std::ranges::any_of(context.spec.structures, [&](const StructureSpec& structure) {
      const auto* other = std::get_if<RetainingWallSpec>(&structure);
      return other != nullptr && Continues(wall, *other, at_s_m);
    });
  };
  for (const StructureSpec& structure : context.spec.structures) {
    const auto* wall = std::get_if<RetainingWallSpec>(&structure);
    if (wall == nullptr || wall->end_s_m < begin_s_m || wall->begin_s_m > end_s_m) continue;
    const TrackCourse* track = TracksOf(context).CourseOf(wall->track);
    if (track == nullptr) continue;
    walls_.push_back({.spec = wall,
                      .track = track,
                      .back_m = SignOf(wall->side) * BackOf_m(*wall),
                      .goes_on_before = goes_on(*wall, wall->begin_s_m),
                      .goes_on_behind = goes_on(*wall, wall->end_s_m)});
  }
  std::ranges::stable_sort(walls_, {}, [](const Wall& wall) { return std::abs(wall.back_m); });
}

double RetainedGround::Behind_m(const Wall& wall, double s_m, double d_m) {
  return SignOf(wall.spec->side) * (d_m - wall.track->OffsetAt(s_m).d_m - wall.back_m);
}

double RetainedGround::Height_m(const CrossSection& section,
                                const GroundPlace& place,
                                const GroundHeights& without,
                                const std::function<bool(double)>& is_in_tunnel) const {
  const auto [s_m, d_m] = place;
  double height_m = without.built_m;
  for (const Wall& wall : walls_) {
    if (!Stands(static_cast<std::size_t>(&wall - walls_.data()), s_m, s_m)) continue;
    const double behind_m = Behind_m(wall, s_m, d_m);
    if (behind_m < -kGroundStep_m) continue;
    const double slope_m = kCutAndFillSlope * std::max(0.0, behind_m);
    const double top_m = wall.track->LiftAt(context_->alignment, s_m).h_m + wall.spec->height_m -
                         kBelowTop_m - section.FormationHeight_m(d_m);
    double behind_wall_m = std::clamp(without.terrain_m, top_m - slope_m, top_m + slope_m);
    constexpr double kEndless_m = std::numeric_limits<double>::infinity();
    const double to_end_m = std::min(wall.goes_on_before ? kEndless_m : s_m - wall.spec->begin_s_m,
                                     wall.goes_on_behind ? kEndless_m : wall.spec->end_s_m - s_m);
    const double change_m = kCutAndFillSlope * to_end_m;
    behind_wall_m = std::clamp(behind_wall_m, height_m - change_m, height_m + change_m);
    // Other tracks behind the wall lie in cuttings or on embankments of their own.
    const double step_d_m = StepAt(static_cast<std::size_t>(&wall - walls_.data()), s_m).front_m;
    const double sign = SignOf(wall.spec->side);
    const double beside_m = section.DistanceFromTracksIf_m(d_m, [&](double track_d_m) {
      return sign * (track_d_m - step_d_m) >= 0.0 && !is_in_tunnel(track_d_m);
    }) - kFormationEdge_m;
    height_m = CutAndFill_m(behind_wall_m, beside_m);
  }
  return height_m;
}

double RetainedGround::Roughness(double s_m, double d_m) const {
  double roughness = 1.0;
  for (std::size_t i = 0; i < walls_.size(); ++i) {
    if (!Stands(i, s_m, s_m)) continue;
    const double behind_m = Behind_m(walls_[i], s_m, d_m);
    if (behind_m < -kGroundStep_m) continue;
    roughness = std::min(roughness, std::clamp(behind_m / kSmoothBehind_m, 0.0, 1.0));
  }
  return roughness;
}

bool RetainedGround::Stands(std::size_t wall, double from_s_m, double to_s_m) const {
  return from_s_m >= walls_[wall].spec->begin_s_m && to_s_m <= walls_[wall].spec->end_s_m;
}

bool RetainedGround::AnyIn(double from_s_m, double to_s_m) const {
  return std::ranges::any_of(walls_, [&](const Wall& wall) {
    return wall.spec->begin_s_m <= to_s_m && wall.spec->end_s_m >= from_s_m;
  });
}

RetainedGround::Step RetainedGround::StepAt(std::size_t wall, double s_m) const {
  const double side = SignOf(walls_[wall].spec->side);
  const double back_m = walls_[wall].track->OffsetAt(s_m).d_m + walls_[wall].back_m;
  return {.front_m = back_m - side * kFrontEnd_m, .back_m = back_m - side * kBackBegin_m};
}

GroundRise::GroundRise(const ChunkContext& context)
    : gaps_(
          TracksOf(context), context.begin_s_m - kBeyondChunk_m, context.end_s_m + kBeyondChunk_m),
      retained_(context, context.begin_s_m - kBeyondChunk_m, context.end_s_m + kBeyondChunk_m),
      hills_(context, context.begin_s_m - kBeyondChunk_m, context.end_s_m + kBeyondChunk_m),
      spec_(context.spec.terrain),
      land_(context.land != nullptr && context.land->has_terrain() ? context.land : nullptr),
      roughness_(context.seed, RandomUse::kGroundRoughness, 0),
      long_wave_(context.seed, RandomUse::kGroundRoughness, 1),
      short_wave_(context.seed, RandomUse::kGroundRoughness, 2) {
  if (land_ != nullptr) world_from_chunk_ = context.chunk_from_world.inverse();
}

double GroundRise::Height_m(const CrossSection& section,
                            double s_m,
                            double d_m,
                            GroundLevel level) const {
  const double ballast_m = section.BallastHeight_m(d_m) - section.FormationHeight_m(d_m);
  double rough = std::clamp(1.0 - ballast_m / kSmoothBelow_m, 0.0, 1.0);
  const double along = s_m / spec_.roughness_wavelength_m;
  const double across = d_m / spec_.roughness_wavelength_m;
  const double distance_m = section.DistanceFromTracks_m(d_m);
  double terrain_m = Undulation_m(distance_m, s_m, d_m);
  double height_m = terrain_m;
  if (land_ != nullptr) {
    const Vector3 formation_m = section.PointAt(d_m, section.FormationHeight_m(d_m));
    const double rise_m = land_->Rise_m(world_from_chunk_ * formation_m);
    terrain_m = rise_m + height_m;
    const double beyond_m = distance_m - kFormationEdge_m;
    height_m = spec_.has_ditches ? CutWithDitchAndFill_m(terrain_m, beyond_m)
                                 : CutAndFill_m(terrain_m, beyond_m);
  }
  if (!hills_.empty() && (level == GroundLevel::kOfHill || !hills_.IsInside(s_m, d_m))) {
    height_m = hills_.Height_m(section, s_m, d_m, {terrain_m, height_m});
    // Within the lining there is no room for it.
    if (hills_.PlaceOf(s_m, d_m) == TunnelHills::Place::kOver) rough = 0.0;
  }
  if (!retained_.empty()) {
    const auto is_in_tunnel = [&](double track_d_m) { return hills_.IsInside(s_m, track_d_m); };
    const double behind_walls_m =
        retained_.Height_m(section, {s_m, d_m}, {terrain_m, height_m}, is_in_tunnel);
    // Over a tunnel, a wall before it may hold more of the hill, but not less.
    height_m = level == GroundLevel::kOfHill ? std::max(height_m, behind_walls_m) : behind_walls_m;
    rough *= retained_.Roughness(s_m, d_m);
  }
  return rough * spec_.roughness_sigma_m * roughness_.At(along, across) + height_m -
         (level == GroundLevel::kOfHill ? 0.0 : Drop_m(s_m, d_m));
}

double GroundRise::Undulation_m(double distance_m, double s_m, double d_m) const {
  const double t =
      std::clamp((distance_m - kLevelReach_m) / (kFullReach_m - kLevelReach_m), 0.0, 1.0);
  if (t == 0.0) return 0.0;
  const double fade = t * t * (3.0 - 2.0 * t);
  const double waves =
      std::sqrt(kLongWaveShare) * long_wave_.At(s_m / kLongWave_m, d_m / kLongWave_m) +
      std::sqrt(1.0 - kLongWaveShare) * short_wave_.At(s_m / kShortWave_m, d_m / kShortWave_m);
  return fade * spec_.undulation_sigma_m * waves;
}

Vector3 GroundRise::PointAt(const CrossSection& section,
                            double s_m,
                            double d_m,
                            GroundLevel level) const {
  return section.PointAt(d_m, section.FormationHeight_m(d_m) + Height_m(section, s_m, d_m, level));
}

Vector3 GroundPoint(const ChunkContext& context, double s_m, double d_m) {
  return GroundPoint(context, CrossSection(context, s_m), s_m, d_m);
}

Vector3 GroundPoint(const ChunkContext& context,
                    const CrossSection& section,
                    double s_m,
                    double d_m) {
  return GroundRise(context).PointAt(section, s_m, d_m);
}

}  // namespace railcast
