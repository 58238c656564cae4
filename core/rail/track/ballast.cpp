#include "core/rail/track/track_structure.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/rail/land/noise_field.h"
#include "core/rail/model_parts.h"
#include "core/rail/track/cross_section.h"
#include "core/rail/track/sweep.h"

namespace railcast {
namespace {

/// A third of the sleeper spacing: one row under every sleeper, where grain is hidden, and two in
/// every crib.
constexpr double kBallastGridAlong_m = kSleeperSpacing_m / 3.0;
constexpr double kGridAcross_m = 0.16;

/// Standard deviation of the heights: sigma_z of docs/physics.md 7.1.
constexpr double kGrainSigma_m = 0.020;

/// Depth below the ground to which the sheet continues, in addition to four sigmas of the ground's
/// roughness.
constexpr double kBelowGround_m = 0.1;

/// Grid columns, in multiples of kGridAcross_m, that cover the ballast of all tracks.
struct Columns {
  std::int64_t first{};
  std::int64_t last{};
};

Columns ColumnsOf(const WorldSpec& spec) {
  // Covers shoulder and slope down to below the ground, with cant. Anything deeper is dropped
  // anyway.
  constexpr double kReach_m = CrossSection::kShoulder_m + 2.0;
  double right_m = std::numeric_limits<double>::infinity();
  double left_m = -right_m;
  for (const TrackSpec& track : spec.tracks) {
    right_m = std::min(right_m, track.offset_m - kReach_m);
    left_m = std::max(left_m, track.offset_m + kReach_m);
  }
  return {.first = static_cast<std::int64_t>(std::floor(right_m / kGridAcross_m)),
          .last = static_cast<std::int64_t>(std::ceil(left_m / kGridAcross_m))};
}

}  // namespace

void AddBallast(const ChunkContext& context, Chunk& chunk) {
  const ChainageRange range{.begin_s_m = context.begin_s_m - 0.5 * kChunkOverlap_m,
                            .end_s_m = context.end_s_m + 0.5 * kChunkOverlap_m};
  const NoiseField grain(context.seed, RandomUse::kBallastRoughness, 0);
  const Columns columns = ColumnsOf(context.spec);
  const auto num_columns = static_cast<std::size_t>(columns.last - columns.first + 1);
  const double lowest_m = -(kBelowGround_m + 4.0 * context.spec.terrain.roughness_sigma_m);

  std::vector<Vector3> points_m;
  std::vector<bool> shows;
  for (const double s_m : GridStations(range, kBallastGridAlong_m)) {
    const CrossSection section(context, s_m);
    for (std::int64_t column = columns.first; column <= columns.last; ++column) {
      const double d_m = static_cast<double>(column) * kGridAcross_m;
      const double formation_m = section.FormationHeight_m(d_m);
      const double ballast_m = section.BallastHeight_m(d_m);
      shows.push_back(ballast_m - formation_m > lowest_m);
      const double grain_m = kGrainSigma_m / NoiseField::kLatticeSigma *
                             grain.At(s_m / kBallastGridAlong_m, static_cast<double>(column));
      // Cells at the edge of the sheet have corners beyond the end of the ballast; keep them in the
      // ground.
      points_m.push_back(
          section.PointAt(d_m, std::max(ballast_m, formation_m + 2.0 * lowest_m) + grain_m));
    }
  }
  const auto keeps = [&](std::size_t row, std::size_t column) {
    const std::size_t corner = row * num_columns + column;
    return shows[corner] || shows[corner + 1] || shows[corner + num_columns] ||
           shows[corner + num_columns + 1];
  };
  const Mesh sheet = MeshOfGrid(points_m, num_columns, keeps);
  if (!sheet.triangles.empty()) MeshOf(context.surfaces.ballast, chunk.ground).Append(sheet);
}

}  // namespace railcast
