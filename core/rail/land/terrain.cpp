#include "core/rail/land/land.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "core/rail/land/noise_field.h"
#include "core/rail/model_parts.h"
#include "core/rail/structures/cleared.h"
#include "core/rail/structures/crossing_road.h"
#include "core/rail/track/coarse_grid.h"
#include "core/rail/track/cross_section.h"
#include "core/rail/track/sweep.h"

namespace railcast {
namespace {

constexpr double kGridAlong_m = 0.5;
constexpr double kFineAcross_m = 0.5;
constexpr double kFineReach_m = 10.0;
constexpr double kCoarsening = 1.15;
constexpr double kCoarsestAcross_m = 2.0;

/// Of the coarser form: the widest cells across. Where ballast may cover them, all are kept.
constexpr double kWholeReach_m = 3.0;
/// A shorter roughness would be lost between rows 1 m apart.
constexpr double kShortWavelength_m = 2.0;
constexpr double kCoarseNearAcross_m = 1.1;
constexpr double kCoarseGroundAcross_m = 2.1;

/// Distance from a track's axis up to which there is no undulation.
constexpr double kLevelReach_m = 4.0;
constexpr double kFullReach_m = 30.0;  ///< Distance from which undulation has its full height.
constexpr double kLongWave_m = 30.0;
constexpr double kShortWave_m = 12.0;
constexpr double kLongWaveShare = 0.8;  ///< Share of the variance.

/// Depth below the top of the ballast over which roughness fades out.
constexpr double kSmoothBelow_m = 0.25;
/// Cells whose corners are all lower than this below the ballast are left out.
constexpr double kHiddenBelow_m = 0.35;

/// The random part of the ground's height.
class Relief {
 public:
  explicit Relief(const ChunkContext& context)
      : tracks_(TracksOf(context)),
        spec_(context.spec.terrain),
        roughness_(context.seed, RandomUse::kGroundRoughness, 0),
        long_wave_(context.seed, RandomUse::kGroundRoughness, 1),
        short_wave_(context.seed, RandomUse::kGroundRoughness, 2) {}

  [[nodiscard]] double Height_m(const CrossSection& section, double s_m, double d_m) const {
    const double ballast_m = section.BallastHeight_m(d_m) - section.FormationHeight_m(d_m);
    const double rough = std::clamp(1.0 - ballast_m / kSmoothBelow_m, 0.0, 1.0);
    const double along = s_m / spec_.roughness_wavelength_m;
    const double across = d_m / spec_.roughness_wavelength_m;
    return rough * spec_.roughness_sigma_m * roughness_.At(along, across) +
           Undulation_m(section.DistanceFromTracks_m(d_m), s_m, d_m) - Drop_m(s_m, d_m);
  }

  /// How much lower the ground is below and about bridges.
  [[nodiscard]] double Drop_m(double s_m, double d_m) const {
    return tracks_.world.structures.empty() ? 0.0 : GroundDrop_m(tracks_, s_m, d_m);
  }

 private:
  [[nodiscard]] double Undulation_m(double distance_m, double s_m, double d_m) const {
    const double t =
        std::clamp((distance_m - kLevelReach_m) / (kFullReach_m - kLevelReach_m), 0.0, 1.0);
    if (t == 0.0) return 0.0;
    const double fade = t * t * (3.0 - 2.0 * t);
    const double waves =
        std::sqrt(kLongWaveShare) * long_wave_.At(s_m / kLongWave_m, d_m / kLongWave_m) +
        std::sqrt(1.0 - kLongWaveShare) * short_wave_.At(s_m / kShortWave_m, d_m / kShortWave_m);
    return fade * spec_.undulation_sigma_m * waves;
  }

  WorldTracks tracks_;
  const TerrainSpec& spec_;
  NoiseField roughness_;
  NoiseField long_wave_;
  NoiseField short_wave_;
};

/// Grid lines outwards from `d_m` to the edge of the strip, which is the last; `side` is +1 for
/// left.
std::vector<double> LinesOutwards(double d_m, double side, double half_width_m) {
  std::vector<double> lines_m;
  double step_m = kFineAcross_m;
  for (double distance_m = side * d_m + step_m; distance_m < half_width_m - 0.5 * step_m;
       distance_m += step_m) {
    lines_m.push_back(side * distance_m);
    step_m = std::min(kCoarsestAcross_m, kCoarsening * step_m);
  }
  lines_m.push_back(side * half_width_m);
  return lines_m;
}

/// The grid's lateral positions from right to left, the same all along the line.
std::vector<double> LateralLines(const WorldSpec& spec, std::span<const TrackCourse> tracks) {
  const double edge_m = spec.terrain.half_width_m;
  const double right_m = std::ranges::min(tracks, {}, &TrackCourse::least_d_m).least_d_m();
  const double left_m = std::ranges::max(tracks, {}, &TrackCourse::most_d_m).most_d_m();
  const double least_m = std::max(right_m - kFineReach_m, -edge_m + kFineAcross_m);
  const double most_m = std::min(left_m + kFineReach_m, edge_m - kFineAcross_m);
  std::vector<double> lines_m;
  for (auto i = static_cast<std::int64_t>(std::ceil(least_m / kFineAcross_m));
       static_cast<double>(i) * kFineAcross_m <= most_m; ++i) {
    lines_m.push_back(static_cast<double>(i) * kFineAcross_m);
  }
  if (lines_m.empty()) lines_m.push_back(0.0);
  const std::vector<double> to_the_right_m = LinesOutwards(lines_m.front(), -1.0, edge_m);
  const std::vector<double> to_the_left_m = LinesOutwards(lines_m.back(), 1.0, edge_m);
  lines_m.insert(lines_m.begin(), to_the_right_m.rbegin(), to_the_right_m.rend());
  lines_m.insert(lines_m.end(), to_the_left_m.begin(), to_the_left_m.end());
  return lines_m;
}

Vector3 PointOf(const CrossSection& section, const Relief& relief, double s_m, double d_m) {
  return section.PointAt(d_m, section.FormationHeight_m(d_m) + relief.Height_m(section, s_m, d_m));
}

/// Rows of the coarser form. Beams at grazing incidence see the slopes along the track, which must
/// stay. Between two points of its lattice, roughness rises as an S (NoiseField), which is nearly
/// straight between its quarters: rows there keep the steep middles and the level rest. A longer
/// lattice is resolved by any rows a metre apart, a shorter one by none but the finest.
std::vector<double> CoarseStations(const ChainageRange& range, double wavelength_m) {
  constexpr double kCoarseAlong_m = 1.0;
  if (wavelength_m < kShortWavelength_m) return GridStations(range, kGridAlong_m);
  if (wavelength_m >= 4.0 * kCoarseAlong_m) return GridStations(range, kCoarseAlong_m);
  const double quarter_m = 0.25 * wavelength_m;
  std::vector<double> stations_m =
      GridStations({.begin_s_m = range.begin_s_m - quarter_m, .end_s_m = range.end_s_m - quarter_m},
                   2.0 * quarter_m);
  for (double& s_m : stations_m) s_m += quarter_m;
  stations_m.front() = range.begin_s_m;
  stations_m.back() = range.end_s_m;
  return stations_m;
}

/// The grid of the ground.
class GroundGrid {
 public:
  explicit GroundGrid(const ChunkContext& context)
      : context_(context),
        relief_(context),
        cleared_(TracksOf(context), Clearing::kGround, context.begin_s_m, context.end_s_m),
        lines_m_(LateralLines(context.spec, context.tracks)),
        roads_(RoadsNear(context, {context.begin_s_m, context.end_s_m})) {}

  [[nodiscard]] Mesh WholeMesh(std::span<const double> stations_m) const {
    std::vector<Vector3> points_m;
    std::vector<bool> shows;
    for (const double s_m : stations_m) {
      const CrossSection section(context_, s_m);
      for (std::size_t column = 0; column < lines_m_.size(); ++column) {
        const GridPoint point = PointAt(section, s_m, column);
        points_m.push_back(point.place_m);
        shows.push_back(point.shows);
      }
    }
    const auto keeps = [&](std::size_t row, std::size_t column) {
      const std::size_t corner = row * lines_m_.size() + column;
      const std::size_t ahead = corner + lines_m_.size();
      return shows[corner] || shows[corner + 1] || shows[ahead] || shows[ahead + 1];
    };
    return MeshOfGrid(points_m, lines_m_.size(), keeps);
  }

  [[nodiscard]] Mesh CoarseMesh(std::span<const double> stations_m) const {
    if (stations_m.size() < 3) return WholeMesh(stations_m);
    std::vector<CrossSection> sections;
    for (const double s_m : stations_m) sections.emplace_back(context_, s_m);
    const auto widest_m = [&](double d_m) {
      const double beside_m = sections.front().DistanceFromTracks_m(d_m);
      // Only the finest grid resolves a roughness as short as this, across as along.
      const bool is_short = context_.spec.terrain.roughness_wavelength_m < kShortWavelength_m;
      if (beside_m < (is_short ? kFineReach_m : kWholeReach_m)) return 0.0;
      return beside_m < kFineReach_m ? kCoarseNearAcross_m : kCoarseGroundAcross_m;
    };
    return MeshOfCoarseGrid(
        {sections.size(), lines_m_.size(), ColumnsAlong(lines_m_, {}, 0.0, widest_m)},
        [&](std::size_t row, std::size_t column) {
          return PointAt(sections[row], stations_m[row], column);
        });
  }

 private:
  [[nodiscard]] GridPoint PointAt(const CrossSection& section,
                                  double s_m,
                                  std::size_t column) const {
    const double d_m = lines_m_[column];
    const double ballast_m = section.BallastHeight_m(d_m) - section.FormationHeight_m(d_m);
    const bool is_hidden = ballast_m > kHiddenBelow_m && relief_.Drop_m(s_m, d_m) == 0.0;
    Vector3 place_m = PointOf(section, relief_, s_m, d_m);
    for (const CrossingRoad& road : roads_) {
      if (const auto limit_m = road.GroundLimit_m(s_m, d_m)) {
        place_m.z() = std::min(place_m.z(), *limit_m);
      }
    }
    return {place_m, !is_hidden && !cleared_.Cover(s_m, d_m)};
  }

  const ChunkContext& context_;
  Relief relief_;
  ClearedAreas cleared_;
  std::vector<double> lines_m_;
  std::vector<CrossingRoad> roads_;  ///< Of level crossings, below which the ground stays.
};

}  // namespace

Vector3 GroundPoint(const ChunkContext& context, double s_m, double d_m) {
  return GroundPoint(context, CrossSection(context, s_m), s_m, d_m);
}

Vector3 GroundPoint(const ChunkContext& context,
                    const CrossSection& section,
                    double s_m,
                    double d_m) {
  return PointOf(section, Relief(context), s_m, d_m);
}

void AddTerrain(const ChunkContext& context, Chunk& chunk) {
  const ChainageRange range{.begin_s_m = context.begin_s_m - 0.5 * kChunkOverlap_m,
                            .end_s_m = context.end_s_m + 0.5 * kChunkOverlap_m};
  const GroundGrid grid(context);
  MeshOf(context.surfaces.ground, chunk.ground)
      .Append(context.is_coarse ? grid.CoarseMesh(CoarseStations(
                                      range, context.spec.terrain.roughness_wavelength_m))
                                : grid.WholeMesh(GridStations(range, kGridAlong_m)));
}

}  // namespace railcast
