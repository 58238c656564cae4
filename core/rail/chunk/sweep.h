#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "core/rail/chunk/chunk_context.h"
#include "core/rail/line/track_course.h"
#include "railcast/scene.h"
#include "railcast/transform.h"

namespace railcast {

/// What of a range a chunk's swept surfaces cover: the chunk with half the overlap at either end,
/// or less where the range begins or ends. If the range does not extend into the chunk, the result
/// ends before it begins.
[[nodiscard]] ChainageRange SweptRange(const ChunkContext& context, const ChainageRange& range);
/// All that the chunk's swept surfaces cover.
[[nodiscard]] inline ChainageRange SweptRange(const ChunkContext& context) {
  return {context.begin_s_m - 0.5 * kChunkOverlap_m, context.end_s_m + 0.5 * kChunkOverlap_m};
}

/// Evenly spaced chainages over the range, such that chords between neighbours deviate from a line
/// `offset_m` left of the axis by at most `tolerance_m`. From the sagitta L^2 kappa / 8 at the
/// highest curvature in the range, in plan and elevation combined, the spacing is at most L =
/// sqrt(8 tolerance / kappa), and never more than `max_step_m`.
[[nodiscard]] std::vector<double> SweepStations(const Alignment& alignment,
                                                const ChainageRange& range,
                                                double offset_m,
                                                double tolerance_m,
                                                double max_step_m);

/// The overload for the axis of a track.
[[nodiscard]] std::vector<double> SweepStations(const Alignment& alignment,
                                                const ChainageRange& range,
                                                const TrackCourse& track,
                                                double tolerance_m,
                                                double max_step_m);

/// The integer multiples of `step_m` in the range, and the ends of the range. A multiple closer to
/// an end than a quarter of a step is dropped.
[[nodiscard]] std::vector<double> GridStations(const ChainageRange& range, double step_m);

/// Adds the points of an outline of (y, z) points in a frame.
void AppendRow(const Transform& mesh_from_row,
               std::span<const Eigen::Vector2d> outline_m,
               Mesh& mesh);
/// Joins the last two rows of a sweep, which have `width` points each.
void JoinRows(std::size_t width, Mesh& mesh);

/// Sweeps an open outline of (y, z) points along a sequence of frames (x forward). With y drawn to
/// the right and z up, the outside is to the left of the outline's direction, so clockwise outlines
/// face outwards.
void AppendSweep(std::span<const Transform> mesh_from_station,
                 std::span<const Eigen::Vector2d> outline_m,
                 Mesh& mesh);

/// Triangulates a grid of points, given row by row, for the cells that `keeps(row, column)` selects
/// by their first corner. Rows run forward and columns to the left, so that the surface faces up.
/// Points that belong to no selected cell are left out.
[[nodiscard]] Mesh MeshOfGrid(std::span<const Vector3> points_m,
                              std::size_t num_columns,
                              const std::function<bool(std::size_t, std::size_t)>& keeps);

/// A grid of which inner rows have only some of the columns (docs/results/detail.md). The first and
/// the last row have all of them, so that they equal those of a neighbouring chunk with the whole
/// grid, and nothing opens between the two.
struct CoarseGrid {
  std::size_t num_rows{};            ///< At least three.
  std::size_t num_all_columns{};     ///< Columns of the first and the last row.
  std::vector<std::size_t> columns;  ///< For others, ascending, with the first and the last one.
};

/// A point of a grid, and whether it may be seen.
struct GridPoint {
  Vector3 place_m = Vector3::Zero();
  bool shows{};
};

/// As MeshOfGrid() does, those cells of which some point shows and that `keeps` selects.
[[nodiscard]] Mesh MeshOfShown(std::span<const GridPoint> points,
                               std::size_t num_columns,
                               const std::function<bool(std::size_t, std::size_t)>& keeps);

/// Triangulates the grid of the points `point_at(row, column)`, with columns counted among all,
/// without the cells of which no point shows. Rows run forward and columns to the left, so that the
/// surface faces up. Points that belong to no cell are left out.
[[nodiscard]] Mesh MeshOfCoarseGrid(
    const CoarseGrid& grid,
    const std::function<GridPoint(std::size_t row, std::size_t column)>& point_at);

/// Picks few of the columns at `places_m`, which ascend: the first, the last, and those between
/// them so that neither is farther from the next than `widest_m` says at both, and that straight
/// lines between them stay within `tolerance_m` of every one of `profiles_m`, which have a height
/// for each column. Neighbouring columns may always follow each other.
[[nodiscard]] std::vector<std::size_t> ColumnsAlong(
    std::span<const double> places_m,
    std::span<const std::vector<double>> profiles_m,
    double tolerance_m,
    const std::function<double(double place_m)>& widest_m);

/// A line of points of the ground along the track, with ascending chainages.
struct GroundLine {
  std::span<const double> stations_m;
  std::span<const Vector3> points_m;  ///< As many.
};

/// Triangles between two lines of points, of which each has rows of its own, so that one may have
/// fewer than the other. The lines begin at one chainage and end at one. The surface faces up.
[[nodiscard]] Mesh MeshBetween(const GroundLine& right, const GroundLine& left);

}  // namespace railcast
