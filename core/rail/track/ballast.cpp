#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "core/rail/base/noise_field.h"
#include "core/rail/base/rail_surfaces.h"
#include "core/rail/chunk/sweep.h"
#include "core/rail/line/rail_section.h"
#include "core/rail/track/cross_section.h"
#include "core/rail/track/track_structure.h"

namespace railcast {
namespace {

/// A third of the sleeper spacing: one row under every sleeper, where grain is hidden, and two in
/// every crib.
constexpr double kBallastGridAlong_m = kSleeperSpacing_m / 3.0;
constexpr double kGridAcross_m = 0.16;

/// The coarser forms: the widest cells across, and how far their mean height may deviate.
constexpr double kCoarseBallastAcross_m[kMostCoarse] = {3.1 * kGridAcross_m, 6.1 * kGridAcross_m};
constexpr double kCoarseBallastTolerances_m[kMostCoarse] = {0.005, 0.05};

/// The coarsest form: the distance of its rows, as a multiple of that of the others.
constexpr double kCoarsestRows = 15.0;

/// Depth below the ground to which the sheet continues, in addition to four sigmas of the ground's
/// roughness.
constexpr double kBelowGround_m = 0.1;

/// Grid columns, in multiples of kGridAcross_m, that cover the ballast of all tracks.
struct Columns {
  std::int64_t first{};
  std::int64_t last{};
};

/// The least and the greatest offset that count for a chunk: those of tracks in it or near, and of
/// all tracks that are parallel to the alignment.
std::pair<double, double> OffsetsIn(const ChunkContext& context) {
  constexpr double kStep_m = 1.0;
  constexpr double kNear_m = 5.0;
  double least_m = std::numeric_limits<double>::infinity();
  double most_m = -least_m;
  const auto add = [&](double d_m) {
    least_m = std::min(least_m, d_m);
    most_m = std::max(most_m, d_m);
  };
  for (const TrackCourse& track : context.tracks) {
    if (track.is_parallel()) {
      add(track.OffsetAt(context.begin_s_m).d_m);
    } else if (track.begin_s_m() < context.end_s_m + kNear_m &&
               track.end_s_m() > context.begin_s_m - kNear_m) {
      for (double s_m = context.begin_s_m; s_m < context.end_s_m + kStep_m; s_m += kStep_m) {
        add(track.OffsetWithin_m(s_m));
      }
    }
  }
  return {least_m, most_m};
}

Columns ColumnsOf(const ChunkContext& context) {
  // Covers shoulder and slope down to below the ground, with cant. Anything deeper is dropped
  // anyway.
  const double reach_m = ShoulderOf_m(context.spec) + 2.0;
  const auto [least_m, most_m] = OffsetsIn(context);
  if (!(least_m <= most_m)) return {};
  return {.first = static_cast<std::int64_t>(std::floor((least_m - reach_m) / kGridAcross_m)),
          .last = static_cast<std::int64_t>(std::ceil((most_m + reach_m) / kGridAcross_m))};
}

/// The sheet of ballast over a grid whose points are counted by row and column.
class BallastSheet {
 public:
  explicit BallastSheet(const ChunkContext& context)
      : context_(context),
        columns_(ColumnsOf(context)),
        lowest_m_(-(kBelowGround_m + 4.0 * context.spec.terrain.roughness_sigma_m)),
        grain_(context.seed, RandomUse::kBallastRoughness, 0),
        stations_m_(GridStations(SweptRange(context),
                                 context.level < kMostCoarse
                                     ? kBallastGridAlong_m
                                     : kCoarsestRows * kBallastGridAlong_m)) {}

  [[nodiscard]] std::size_t num_columns() const {
    return static_cast<std::size_t>(columns_.last - columns_.first + 1);
  }
  [[nodiscard]] std::span<const double> stations_m() const { return stations_m_; }

  [[nodiscard]] GridPoint PointAt(const CrossSection& section,
                                  double s_m,
                                  std::size_t column) const {
    const double d_m = PlaceOf_m(column);
    const double formation_m = section.FormationHeight_m(d_m);
    const double ballast_m = section.BallastHeight_m(d_m);
    const double grain_m =
        context_.spec.ballast.grain_sigma_m / NoiseField::kLatticeSigma *
        grain_.At(s_m / kBallastGridAlong_m,
                  static_cast<double>(columns_.first + static_cast<std::int64_t>(column)));
    // Cells at the edge of the sheet have corners beyond the end of the ballast; keep them in the
    // ground.
    return {section.PointAt(d_m, std::max(ballast_m, formation_m + 2.0 * lowest_m_) + grain_m),
            ballast_m - formation_m > lowest_m_};
  }

  /// The columns of a coarser form: as far apart as kCoarseBallastAcross_m, but for those that
  /// the shape of the ballast needs, at and between the sleepers.
  [[nodiscard]] std::vector<std::size_t> CoarseColumns() const {
    std::vector<double> places_m;
    for (std::size_t column = 0; column < num_columns(); ++column) {
      places_m.push_back(PlaceOf_m(column));
    }
    std::vector<std::vector<double>> profiles_m;
    for (const double s_m : ProfilePlaces_m()) {
      const CrossSection section(context_, s_m);
      std::vector<double>& profile_m = profiles_m.emplace_back();
      for (const double d_m : places_m) {
        profile_m.push_back(
            std::max(section.BallastHeight_m(d_m), section.FormationHeight_m(d_m) + lowest_m_));
      }
    }
    return ColumnsAlong(places_m, profiles_m, kCoarseBallastTolerances_m[context_.level - 1],
                        [this](double) { return kCoarseBallastAcross_m[context_.level - 1]; });
  }

 private:
  /// Chainages whose cross-sections show the ballast of every track, at and between sleepers: near
  /// the middle of the chunk, and of what a track that begins or ends inside has of it.
  [[nodiscard]] std::vector<double> ProfilePlaces_m() const {
    std::vector<double> places_m;
    const auto add = [&](double begin_s_m, double end_s_m) {
      const double sleeper_s_m =
          kSleeperSpacing_m * std::round(0.5 * (begin_s_m + end_s_m) / kSleeperSpacing_m);
      places_m.push_back(sleeper_s_m);
      places_m.push_back(sleeper_s_m + 0.5 * kSleeperSpacing_m);
    };
    add(context_.begin_s_m, context_.end_s_m);
    for (const TrackCourse& track : context_.tracks) {
      const double begin_s_m = std::max(context_.begin_s_m, track.begin_s_m());
      const double end_s_m = std::min(context_.end_s_m, track.end_s_m());
      const bool is_whole = begin_s_m == context_.begin_s_m && end_s_m == context_.end_s_m;
      if (!is_whole && begin_s_m < end_s_m) add(begin_s_m, end_s_m);
    }
    return places_m;
  }
  [[nodiscard]] double PlaceOf_m(std::size_t column) const {
    return static_cast<double>(columns_.first + static_cast<std::int64_t>(column)) * kGridAcross_m;
  }

  const ChunkContext& context_;
  Columns columns_;
  double lowest_m_;
  NoiseField grain_;
  std::vector<double> stations_m_;
};

Mesh WholeBallast(const ChunkContext& context, const BallastSheet& sheet) {
  std::vector<GridPoint> points;
  for (const double s_m : sheet.stations_m()) {
    const CrossSection section(context, s_m);
    for (std::size_t column = 0; column < sheet.num_columns(); ++column) {
      points.push_back(sheet.PointAt(section, s_m, column));
    }
  }
  return MeshOfShown(points, sheet.num_columns(), [](std::size_t, std::size_t) { return true; });
}

Mesh CoarseBallast(const ChunkContext& context, const BallastSheet& sheet) {
  std::vector<CrossSection> sections;
  for (const double s_m : sheet.stations_m()) sections.emplace_back(context, s_m);
  return MeshOfCoarseGrid({sections.size(), sheet.num_columns(), sheet.CoarseColumns()},
                          [&](std::size_t row, std::size_t column) {
                            return sheet.PointAt(sections[row], sheet.stations_m()[row], column);
                          });
}

}  // namespace

void AddBallast(const ChunkContext& context, Chunk& chunk) {
  const BallastSheet sheet(context);
  // The coarser forms have straight columns, which tracks that wander across them do not permit.
  const bool is_straight = std::ranges::all_of(context.tracks, [&](const TrackCourse& track) {
    return track.IsLevelIn(context.begin_s_m, context.end_s_m);
  });
  const bool is_coarse = context.level > 0 && is_straight && sheet.stations_m().size() > 2;
  const Mesh mesh = is_coarse ? CoarseBallast(context, sheet) : WholeBallast(context, sheet);
  if (!mesh.triangles.empty()) MeshOf(context.surfaces.ballast, chunk.ground).Append(mesh);
}

}  // namespace railcast
