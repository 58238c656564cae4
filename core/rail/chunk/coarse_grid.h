#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "railcast/scene.h"
#include "railcast/transform.h"

namespace railcast {

/// A grid of which inner rows have only some of the columns (docs/detail.md). The first and the
/// last row have all of them, so that they equal those of a neighbouring chunk with the whole grid,
/// and nothing opens between the two.
struct CoarseGrid {
  std::size_t num_rows{};            ///< At least three.
  std::size_t num_all_columns{};     ///< Of the first and the last row.
  std::vector<std::size_t> columns;  ///< Of the others, ascending, with the first and the last one.
};

/// A point of a grid, and whether it may be seen.
struct GridPoint {
  Vector3 place_m = Vector3::Zero();
  bool shows{};
};

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
