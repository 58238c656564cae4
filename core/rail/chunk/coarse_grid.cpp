#include "core/rail/chunk/coarse_grid.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <utility>

#include "core/base/error.h"

namespace railcast {
namespace {

/// A row of a grid. Edge rows have points in all columns, the others in some.
struct GridRow {
  std::vector<std::size_t> columns;
  std::vector<GridPoint> points;
  std::vector<std::uint32_t> vertices;

  /// Indices of the first and the last point of the cell between two columns.
  [[nodiscard]] std::pair<std::size_t, std::size_t> Between(std::size_t right,
                                                            std::size_t left) const {
    const auto first = std::ranges::lower_bound(columns, right);
    const auto last = std::ranges::lower_bound(columns, left);
    return {first - columns.begin(), last - columns.begin()};
  }
};

class CoarseGridMesh {
 public:
  explicit CoarseGridMesh(const CoarseGrid& grid) : columns_(grid.columns) {}

  void FillBetween(GridRow& near, GridRow& far) {
    for (std::size_t k = 0; k + 1 < columns_.size(); ++k) {
      const auto of_near = near.Between(columns_[k], columns_[k + 1]);
      const auto of_far = far.Between(columns_[k], columns_[k + 1]);
      if (Shows(near, of_near) || Shows(far, of_far)) FillCell(near, of_near, far, of_far);
    }
  }

  [[nodiscard]] Mesh& mesh() { return mesh_; }

 private:
  using Span = std::pair<std::size_t, std::size_t>;

  static bool Shows(const GridRow& row, const Span& cell) {
    const auto shows = [](const GridPoint& point) { return point.shows; };
    return std::any_of(row.points.begin() + static_cast<std::ptrdiff_t>(cell.first),
                       row.points.begin() + static_cast<std::ptrdiff_t>(cell.second) + 1, shows);
  }

  /// Goes along both rows at once, a triangle for every step on either.
  void FillCell(GridRow& near, const Span& of_near, GridRow& far, const Span& of_far) {
    const std::size_t near_steps = of_near.second - of_near.first;
    const std::size_t far_steps = of_far.second - of_far.first;
    std::size_t i = 0;
    std::size_t j = 0;
    while (i < near_steps || j < far_steps) {
      const std::uint32_t right = VertexOf(near, of_near.first + i);
      const std::uint32_t far_right = VertexOf(far, of_far.first + j);
      const bool is_near_behind = (i + 1) * far_steps < (j + 1) * near_steps;
      const std::uint32_t next =
          is_near_behind ? VertexOf(near, of_near.first + ++i) : VertexOf(far, of_far.first + ++j);
      mesh_.triangles.push_back({right, far_right, next});
    }
  }

  std::uint32_t VertexOf(GridRow& row, std::size_t index) {
    constexpr auto kUnused = std::numeric_limits<std::uint32_t>::max();
    row.vertices.resize(row.points.size(), kUnused);
    if (row.vertices[index] == kUnused) {
      row.vertices[index] = static_cast<std::uint32_t>(mesh_.vertices.size());
      mesh_.vertices.emplace_back(row.points[index].place_m.cast<float>());
    }
    return row.vertices[index];
  }

  const std::vector<std::size_t>& columns_;
  Mesh mesh_;
};

}  // namespace

Mesh MeshOfCoarseGrid(
    const CoarseGrid& grid,
    const std::function<GridPoint(std::size_t row, std::size_t column)>& point_at) {
  const std::size_t num_rows = grid.num_rows;
  Check(num_rows >= 3, "a coarse grid has rows between its edges");
  std::vector<std::size_t> all_columns(grid.num_all_columns);
  std::iota(all_columns.begin(), all_columns.end(), std::size_t{0});
  CoarseGridMesh mesh(grid);
  GridRow near;
  for (std::size_t row = 0; row < num_rows; ++row) {
    const bool is_edge = row == 0 || row + 1 == num_rows;
    GridRow far{.columns = is_edge ? all_columns : grid.columns, .points = {}, .vertices = {}};
    for (const std::size_t column : far.columns) far.points.push_back(point_at(row, column));
    if (row > 0) mesh.FillBetween(near, far);
    near = std::move(far);
  }
  return std::move(mesh.mesh());
}

std::vector<std::size_t> ColumnsAlong(std::span<const double> places_m,
                                      std::span<const std::vector<double>> profiles_m,
                                      double tolerance_m,
                                      const std::function<double(double place_m)>& widest_m) {
  const auto spans = [&](std::size_t first, std::size_t last) {
    const double width_m = places_m[last] - places_m[first];
    if (width_m > std::min(widest_m(places_m[first]), widest_m(places_m[last]))) return false;
    for (const std::vector<double>& profile_m : profiles_m) {
      for (std::size_t k = first + 1; k < last; ++k) {
        const double line_m =
            std::lerp(profile_m[first], profile_m[last], (places_m[k] - places_m[first]) / width_m);
        if (std::abs(profile_m[k] - line_m) > tolerance_m) return false;
      }
    }
    return true;
  };
  std::vector<std::size_t> columns{0};
  while (columns.back() + 1 < places_m.size()) {
    std::size_t next = columns.back() + 1;
    while (next + 1 < places_m.size() && spans(columns.back(), next + 1)) ++next;
    columns.push_back(next);
  }
  return columns;
}

Mesh MeshBetween(const GroundLine& right, const GroundLine& left) {
  const std::size_t num_right = right.points_m.size();
  const std::size_t num_left = left.points_m.size();
  Check(num_right >= 2 && num_left >= 2, "a line of the ground has two ends");
  Mesh mesh;
  for (const GroundLine& line : {right, left}) {
    for (const Vector3& point_m : line.points_m) mesh.vertices.emplace_back(point_m.cast<float>());
  }
  std::size_t i = 0;
  std::size_t j = 0;
  while (i + 1 < num_right || j + 1 < num_left) {
    const auto right_vertex = static_cast<std::uint32_t>(i);
    const auto left_vertex = static_cast<std::uint32_t>(num_right + j);
    const bool is_right_next =
        j + 1 == num_left ||
        (i + 1 < num_right && right.stations_m[i + 1] <= left.stations_m[j + 1]);
    if (is_right_next) {
      mesh.triangles.push_back({right_vertex, right_vertex + 1, left_vertex});
      ++i;
    } else {
      mesh.triangles.push_back({right_vertex, left_vertex + 1, left_vertex});
      ++j;
    }
  }
  return mesh;
}

}  // namespace railcast
