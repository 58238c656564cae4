#include "core/rail/ground/terrain.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "core/rail/chunk/sweep.h"
#include "core/rail/clearance/cleared.h"
#include "core/rail/landform/ground_rise.h"
#include "core/rail/landform/landform.h"
#include "core/rail/structures/crossing_road.h"
#include "core/rail/track/cross_section.h"

namespace railcast {
namespace {

constexpr double kGridAlong_m = 0.5;
constexpr double kFineAcross_m = 0.5;
constexpr double kFineReach_m = 10.0;
constexpr double kCoarsening = 1.15;
constexpr double kCoarsestAcross_m = 2.0;
/// Wide ground: where the far part of the grid begins, and its largest cells.
constexpr double kFarReach_m = 100.0;
constexpr double kFarAcross_m = 8.0;
constexpr double kFarAlong_m = 4.0;

/// The coarser forms: the widest cells across. Where ballast may cover them, all are kept.
constexpr double kWholeReach_m = 3.0;
/// A shorter roughness would be lost between rows 1 m apart.
constexpr double kShortWavelength_m = 2.0;
constexpr double kCoarseNearAcross_m[kMostCoarse] = {1.1, 2.1};
constexpr double kCoarseGroundAcross_m[kMostCoarse] = {2.1, 4.2};
/// The coarsest form: the distance of its rows.
constexpr double kCoarsestAlong_m = 5.0;
/// Cuttings and embankments need their edges: the lesser cells reach farther there.
constexpr double kShapedReach_m = 25.0;

/// Cells whose corners are all lower than this below the ballast are left out.
constexpr double kHiddenBelow_m = 0.35;

/// The width of the strip, and whether cells may be larger far from the track.
struct GroundExtent {
  double half_width_m{};
  bool is_wide{};
};

/// Grid lines outwards from `d_m` to the edge of the strip, which is the last; `side` is +1 for
/// left.
std::vector<double> LinesOutwards(double d_m, double side, const GroundExtent& ground) {
  std::vector<double> lines_m;
  double step_m = kFineAcross_m;
  for (double distance_m = side * d_m + step_m; distance_m < ground.half_width_m - 0.5 * step_m;
       distance_m += step_m) {
    lines_m.push_back(side * distance_m);
    const bool is_far = ground.is_wide && distance_m >= kFarReach_m;
    step_m = std::min(is_far ? kFarAcross_m : kCoarsestAcross_m, kCoarsening * step_m);
  }
  lines_m.push_back(side * ground.half_width_m);
  return lines_m;
}

/// Least and greatest lateral position of the tracks, all along the line.
std::pair<double, double> OutermostTracks_m(std::span<const TrackCourse> tracks) {
  return {std::ranges::min(tracks, {}, &TrackCourse::least_d_m).least_d_m(),
          std::ranges::max(tracks, {}, &TrackCourse::most_d_m).most_d_m()};
}

/// The grid's lateral positions from right to left, the same all along the line.
std::vector<double> LateralLines(const ChunkContext& context, bool is_wide) {
  const double edge_m = context.spec.terrain.half_width_m;
  const auto [right_m, left_m] = OutermostTracks_m(context.tracks);
  const double least_m = std::max(right_m - kFineReach_m, -edge_m + kFineAcross_m);
  const double most_m = std::min(left_m + kFineReach_m, edge_m - kFineAcross_m);
  std::vector<double> lines_m;
  for (auto i = static_cast<std::int64_t>(std::ceil(least_m / kFineAcross_m));
       static_cast<double>(i) * kFineAcross_m <= most_m; ++i) {
    lines_m.push_back(static_cast<double>(i) * kFineAcross_m);
  }
  if (lines_m.empty()) lines_m.push_back(0.0);
  const GroundExtent ground{edge_m, is_wide};
  const std::vector<double> to_the_right_m = LinesOutwards(lines_m.front(), -1.0, ground);
  const std::vector<double> to_the_left_m = LinesOutwards(lines_m.back(), 1.0, ground);
  lines_m.insert(lines_m.begin(), to_the_right_m.rbegin(), to_the_right_m.rend());
  lines_m.insert(lines_m.end(), to_the_left_m.begin(), to_the_left_m.end());
  return lines_m;
}

/// Rows of the coarser forms. Beams at grazing incidence see the slopes along the track, which must
/// stay. Between two points of its lattice, roughness rises as an S (NoiseField), which is nearly
/// straight between its quarters: rows there keep the steep middles and the level rest. A longer
/// lattice is resolved by any rows a metre apart, a shorter one by none but the finest.
std::vector<double> CoarseStations(const ChainageRange& range, const ChunkContext& context) {
  constexpr double kCoarseAlong_m = 1.0;
  const double wavelength_m = context.spec.terrain.roughness_wavelength_m;
  if (context.level == kMostCoarse) return GridStations(range, kCoarsestAlong_m);
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

/// Where the grid is as the spec has it and where it is squeezed, as the strip narrows.
class GroundColumns {
 public:
  explicit GroundColumns(const ChunkContext& context)
      : half_width_m_(context.spec.terrain.half_width_m),
        is_wide_(context.land != nullptr && context.land->is_wide()),
        lines_m_(LateralLines(context, is_wide_)) {
    if (context.land == nullptr || !context.land->width().narrows()) return;
    width_ = &context.land->width();
    const auto [right, left] = OutermostTracks_m(context.tracks);
    const double most_m = 0.5 * width_->least_m();
    kept_right_m_ = std::clamp(kFineReach_m - right, 0.0, most_m);
    kept_left_m_ = std::clamp(kFineReach_m + left, 0.0, most_m);
  }

  [[nodiscard]] const std::vector<double>& lines_m() const { return lines_m_; }
  /// The columns of the near part; all, if the ground is not wide.
  [[nodiscard]] std::size_t first_near() const { return is_wide_ ? IndexOf(-kFarReach_m) : 0; }
  [[nodiscard]] std::size_t last_near() const {
    return is_wide_ ? std::min(IndexOf(kFarReach_m), lines_m_.size() - 1) : lines_m_.size() - 1;
  }
  /// Lateral position of a column at a chainage.
  [[nodiscard]] double PlaceOf_m(double s_m, std::size_t column) const {
    const double line_m = lines_m_[column];
    if (width_ == nullptr) return line_m;
    const double side = line_m < 0.0 ? -1.0 : 1.0;
    const double kept_m = side < 0.0 ? kept_right_m_ : kept_left_m_;
    const double beyond_m = side * line_m - kept_m;
    if (beyond_m <= 0.0) return line_m;
    const double share = (width_->At(s_m, side) - kept_m) / (half_width_m_ - kept_m);
    return side * (kept_m + beyond_m * share);
  }

 private:
  [[nodiscard]] std::size_t IndexOf(double line_m) const {
    return static_cast<std::size_t>(std::ranges::lower_bound(lines_m_, line_m) - lines_m_.begin());
  }

  double half_width_m_;
  bool is_wide_;
  std::vector<double> lines_m_;        ///< From right to left.
  const StripWidth* width_ = nullptr;  ///< Null: equally wide everywhere.
  double kept_right_m_{};              ///< Distance from the axis up to which nothing is squeezed.
  double kept_left_m_{};
};

/// The grid of the ground.
class GroundGrid {
 public:
  explicit GroundGrid(const ChunkContext& context)
      : context_(context),
        rise_(context),
        columns_(context),
        cleared_(TracksOf(context), Clearing::kGround, context.begin_s_m, context.end_s_m),
        roads_(RoadsNear(context, {context.begin_s_m, context.end_s_m})),
        first_(columns_.first_near()),
        num_columns_(columns_.last_near() + 1 - first_) {}

  [[nodiscard]] Mesh WholeMesh(std::span<const double> stations_m) const {
    std::vector<GridPoint> points;
    for (const double s_m : stations_m) {
      const CrossSection section(context_, s_m);
      for (std::size_t column = 0; column < num_columns_; ++column) {
        points.push_back(PointAt(section, s_m, columns_.PlaceOf_m(s_m, first_ + column)));
      }
    }
    const std::vector<StepGap> gaps = GapsAtSteps(stations_m);
    const auto keeps = [&](std::size_t row, std::size_t column) {
      return std::ranges::none_of(gaps,
                                  [&](const StepGap& gap) {
                                    return gap.row == row && column >= gap.right &&
                                           column < gap.left;
                                  }) &&
             !IsInMouth(stations_m, row, column);
    };
    Mesh mesh = MeshOfShown(points, num_columns_, keeps);
    for (const StepGap& gap : gaps) FillBesideStep(stations_m, gap, mesh);
    return mesh;
  }

  /// Whether the ground has steps, for which all rows and columns are needed.
  [[nodiscard]] bool has_steps() const {
    return rise_.retained().AnyIn(context_.begin_s_m, context_.end_s_m) ||
           rise_.hills().AnyIn(context_.begin_s_m, context_.end_s_m);
  }

  [[nodiscard]] Mesh CoarseMesh(std::span<const double> stations_m) const {
    if (stations_m.size() < 3) return WholeMesh(stations_m);
    std::vector<CrossSection> sections;
    for (const double s_m : stations_m) sections.emplace_back(context_, s_m);
    const bool is_shaped = context_.land != nullptr && context_.land->has_terrain();
    const double near_reach_m = is_shaped ? kShapedReach_m : kFineReach_m;
    const auto widest_m = [&](double d_m) {
      // Lines lie at whole distances from the tracks, which rounding must not put on either side
      // of a limit.
      constexpr double kRounding_m = 1e-6;
      const double beside_m = sections.front().DistanceFromTracks_m(d_m) + kRounding_m;
      // Only the finest grid resolves a roughness as short as this, across as along.
      const bool is_short = context_.spec.terrain.roughness_wavelength_m < kShortWavelength_m;
      if (beside_m < (is_short ? kFineReach_m : kWholeReach_m)) return 0.0;
      return (beside_m < near_reach_m ? kCoarseNearAcross_m
                                      : kCoarseGroundAcross_m)[context_.level - 1];
    };
    const std::span<const double> lines_m(columns_.lines_m().data() + first_, num_columns_);
    return MeshOfCoarseGrid(
        {sections.size(), num_columns_, ColumnsAlong(lines_m, {}, 0.0, widest_m)},
        [&](std::size_t row, std::size_t column) {
          const double s_m = stations_m[row];
          return PointAt(sections[row], s_m, columns_.PlaceOf_m(s_m, first_ + column));
        });
  }

  /// What lies beyond the near part, the same in both forms, joined to the near part's rows at
  /// `stations_m`.
  [[nodiscard]] Mesh FarMesh(std::span<const double> stations_m) const {
    const std::size_t num_all = columns_.lines_m().size();
    Mesh mesh;
    if (num_columns_ == num_all) return mesh;
    const Rows near(context_, {stations_m.begin(), stations_m.end()});
    const Rows far(
        context_,
        GridStations({.begin_s_m = stations_m.front(), .end_s_m = stations_m.back()}, kFarAlong_m));
    const std::size_t last = first_ + num_columns_ - 1;
    for (std::size_t column = 0; column + 1 < num_all; ++column) {
      if (column >= first_ && column < last) continue;
      const Rows& of_right = column == last ? near : far;
      const Rows& of_left = column + 1 == first_ ? near : far;
      const std::vector<Vector3> right = LineAt(of_right, column);
      const std::vector<Vector3> left = LineAt(of_left, column + 1);
      mesh.Append(MeshBetween({of_right.stations_m, right}, {of_left.stations_m, left}));
    }
    return mesh;
  }

 private:
  struct Rows {
    Rows(const ChunkContext& context, std::vector<double> at_s_m) : stations_m(std::move(at_s_m)) {
      for (const double s_m : stations_m) sections.emplace_back(context, s_m);
    }
    std::vector<double> stations_m;
    std::vector<CrossSection> sections;
  };

  /// Cells that a step at a retaining wall leaves out: those between two columns of the near part,
  /// from one row to the next.
  struct StepGap {
    std::size_t wall{};
    std::size_t row{};
    std::size_t right{};
    std::size_t left{};
  };

  [[nodiscard]] std::vector<StepGap> GapsAtSteps(std::span<const double> stations_m) const {
    const RetainedGround& retained = rise_.retained();
    std::vector<StepGap> gaps;
    for (std::size_t wall = 0; wall < retained.num_walls(); ++wall) {
      for (std::size_t row = 0; row + 1 < stations_m.size(); ++row) {
        if (!retained.Stands(wall, stations_m[row], stations_m[row + 1])) continue;
        StepGap gap{.wall = wall, .row = row, .right = 0, .left = num_columns_ - 1};
        for (const double s_m : {stations_m[row], stations_m[row + 1]}) {
          const auto [front_m, back_m] = retained.StepAt(wall, s_m);
          std::size_t right = 0;
          while (right < num_columns_ &&
                 columns_.PlaceOf_m(s_m, first_ + right) < std::min(front_m, back_m)) {
            ++right;
          }
          std::size_t left = right;
          while (left < num_columns_ &&
                 columns_.PlaceOf_m(s_m, first_ + left) <= std::max(front_m, back_m)) {
            ++left;
          }
          const bool is_first = s_m == stations_m[row];
          gap.right = is_first ? right : std::min(gap.right, right);
          gap.left = is_first ? left : std::max(gap.left, left);
        }
        // Beyond the near part, a wall stands in a slope.
        if (gap.right == 0 || gap.left >= num_columns_) continue;
        --gap.right;
        gaps.push_back(gap);
      }
    }
    return gaps;
  }

  /// Whether a cell would join the ground in a tunnel's mouth with that above the tunnel.
  [[nodiscard]] bool IsInMouth(std::span<const double> stations_m,
                               std::size_t row,
                               std::size_t column) const {
    if (rise_.hills().empty()) return false;
    bool is_mouth = false;
    bool is_over = false;
    for (const double s_m : {stations_m[row], stations_m[row + 1]}) {
      for (const std::size_t corner : {column, column + 1}) {
        const TunnelHills::Place place =
            rise_.hills().PlaceOf(s_m, columns_.PlaceOf_m(s_m, first_ + corner));
        is_mouth = is_mouth || place == TunnelHills::Place::kMouth;
        is_over = is_over || place == TunnelHills::Place::kOver;
      }
    }
    return is_mouth && is_over;
  }

  /// Adds the ground between the columns beside a gap and the step.
  void FillBesideStep(std::span<const double> stations_m, const StepGap& gap, Mesh& mesh) const {
    std::vector<Vector3> points_m;
    for (const double s_m : {stations_m[gap.row], stations_m[gap.row + 1]}) {
      const CrossSection section(context_, s_m);
      const auto [front_m, back_m] = rise_.retained().StepAt(gap.wall, s_m);
      for (const double d_m :
           {columns_.PlaceOf_m(s_m, first_ + gap.right), std::min(front_m, back_m),
            std::max(front_m, back_m), columns_.PlaceOf_m(s_m, first_ + gap.left)}) {
        points_m.push_back(PointAt(section, s_m, d_m).place_m);
      }
    }
    // Not the second of the three cells, which is inside the wall.
    mesh.Append(
        MeshOfGrid(points_m, 4, [](std::size_t, std::size_t column) { return column != 1; }));
  }

  [[nodiscard]] GridPoint PointAt(const CrossSection& section, double s_m, double d_m) const {
    const double ballast_m = section.BallastHeight_m(d_m) - section.FormationHeight_m(d_m);
    const bool is_hidden = ballast_m > kHiddenBelow_m && rise_.Drop_m(s_m, d_m) == 0.0;
    const bool is_over = rise_.hills().PlaceOf(s_m, d_m) == TunnelHills::Place::kOver;
    const GroundLevel level = is_over ? GroundLevel::kOfHill : GroundLevel::kOfTrack;
    Vector3 place_m = rise_.PointAt(section, s_m, d_m, level);
    for (const CrossingRoad& road : roads_) {
      if (const auto limit_m = road.GroundLimit_m(s_m, d_m)) {
        place_m.z() = std::min(place_m.z(), *limit_m);
      }
    }
    return {place_m, is_over || (!is_hidden && !cleared_.Cover(s_m, d_m))};
  }

  /// @param column Of all.
  [[nodiscard]] std::vector<Vector3> LineAt(const Rows& rows, std::size_t column) const {
    std::vector<Vector3> points_m;
    for (std::size_t i = 0; i < rows.stations_m.size(); ++i) {
      const double s_m = rows.stations_m[i];
      const double d_m = columns_.PlaceOf_m(s_m, column);
      points_m.push_back(rise_.PointAt(rows.sections[i], s_m, d_m));
    }
    return points_m;
  }

  const ChunkContext& context_;
  GroundRise rise_;
  GroundColumns columns_;
  ClearedAreas cleared_;
  std::vector<CrossingRoad> roads_;  ///< Roads of level crossings, below which the ground stays.
  std::size_t first_;                ///< First column of the near part.
  std::size_t num_columns_;
};

}  // namespace

void AddTerrain(const ChunkContext& context, Chunk& chunk) {
  const ChainageRange range = SweptRange(context);
  const GroundGrid grid(context);
  const bool is_coarse = context.level > 0 && !grid.has_steps();
  const std::vector<double> stations_m =
      is_coarse ? CoarseStations(range, context) : GridStations(range, kGridAlong_m);
  Mesh ground = is_coarse ? grid.CoarseMesh(stations_m) : grid.WholeMesh(stations_m);
  ground.Append(grid.FarMesh(stations_m));
  AddGround(context, ground, chunk);
}

}  // namespace railcast
