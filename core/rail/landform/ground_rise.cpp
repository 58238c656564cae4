#include "core/rail/landform/ground_rise.h"

#include <algorithm>
#include <cmath>

#include "core/rail/landform/landform.h"

namespace railcast {
namespace {

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
