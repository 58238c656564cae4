#include "core/rail/chunk/sweep.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <utility>

#include "core/base/error.h"

namespace railcast {
namespace {

/// As SweepStations() does, for a line whose curvature in plan, relative to a step of the axis'
/// chainage, is `plan_per_m(chainage)`.
template <typename Plan>
std::vector<double> EvenStations(const Alignment& alignment,
                                 const ChainageRange& range,
                                 const Plan& plan_per_m,
                                 double tolerance_m,
                                 double max_step_m) {
  Check(range.begin_s_m < range.end_s_m, "a sweep has a length");
  constexpr double kSampling_m = 1.0;
  const double length_m = range.end_s_m - range.begin_s_m;
  const auto num_samples = static_cast<int>(std::ceil(length_m / kSampling_m)) + 1;
  double strongest_per_m = 0.0;
  for (int i = 0; i <= num_samples; ++i) {
    const double s_m = range.begin_s_m + length_m * i / num_samples;
    // Beyond its ends, the line is level whatever the gradient at the end.
    const double before_s_m = std::max(0.0, s_m - 0.5 * kSampling_m);
    const double after_s_m = std::min(alignment.length_m(), s_m + 0.5 * kSampling_m);
    const double elevation_per_m =
        (alignment.At(after_s_m).gradient - alignment.At(before_s_m).gradient) / kSampling_m;
    strongest_per_m = std::max(strongest_per_m, std::hypot(plan_per_m(s_m), elevation_per_m));
  }
  // The deviation of a chord over a step L is at most L^2 / 8 times the curvature.
  const double step_m = std::min(max_step_m, std::sqrt(8.0 * tolerance_m / strongest_per_m));
  const auto num_steps = static_cast<int>(std::ceil(length_m / step_m));
  std::vector<double> stations_m;
  for (int i = 0; i <= num_steps; ++i) {
    stations_m.push_back(range.begin_s_m + length_m * i / num_steps);
  }
  return stations_m;
}

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

ChainageRange SweptRange(const ChunkContext& context, const ChainageRange& range) {
  const ChainageRange whole = SweptRange(context);
  return {.begin_s_m = std::max(whole.begin_s_m, range.begin_s_m),
          .end_s_m = std::min(whole.end_s_m, range.end_s_m)};
}

std::vector<double> SweepStations(const Alignment& alignment,
                                  const ChainageRange& range,
                                  double offset_m,
                                  double tolerance_m,
                                  double max_step_m) {
  // The line has the radius R - d and the chord L (R - d) / R, so that the sagitta is L^2 (1 - d /
  // R) / (8 R).
  const auto plan_per_m = [&](double s_m) {
    const double axis_per_m = alignment.At(s_m).curvature_per_m;
    return axis_per_m * (1.0 - axis_per_m * offset_m);
  };
  return EvenStations(alignment, range, plan_per_m, tolerance_m, max_step_m);
}

std::vector<double> SweepStations(const Alignment& alignment,
                                  const ChainageRange& range,
                                  const TrackCourse& track,
                                  double tolerance_m,
                                  double max_step_m) {
  if (track.is_parallel()) {
    return SweepStations(alignment, range, track.OffsetAt(range.begin_s_m).d_m, tolerance_m,
                         max_step_m);
  }
  // A step of chainage is longer on the track by hypot(1 - kappa d, d').
  const auto plan_per_m = [&](double s_m) {
    const double axis_per_m = alignment.At(s_m).curvature_per_m;
    const TrackOffset offset = track.OffsetAt(s_m);
    const double stretch = std::hypot(1.0 - axis_per_m * offset.d_m, offset.slope);
    // The curvature of the track's height, where it leaves the plane of another track.
    const double lift_per_m =
        track.LiftAt(alignment, s_m + 0.5).slope - track.LiftAt(alignment, s_m - 0.5).slope;
    return std::hypot(track.CurvatureAt(alignment, s_m) * stretch * stretch, lift_per_m);
  };
  return EvenStations(alignment, range, plan_per_m, tolerance_m, max_step_m);
}

std::vector<double> GridStations(const ChainageRange& range, double step_m) {
  Check(range.begin_s_m < range.end_s_m, "a grid has a length");
  std::vector<double> stations_m{range.begin_s_m};
  const auto first = static_cast<std::int64_t>(std::ceil(range.begin_s_m / step_m + 0.25));
  const auto last = static_cast<std::int64_t>(std::floor(range.end_s_m / step_m - 0.25));
  for (std::int64_t i = first; i <= last; ++i) {
    stations_m.push_back(static_cast<double>(i) * step_m);
  }
  stations_m.push_back(range.end_s_m);
  return stations_m;
}

void AppendRow(const Transform& mesh_from_row,
               std::span<const Eigen::Vector2d> outline_m,
               Mesh& mesh) {
  for (const Eigen::Vector2d& point : outline_m) {
    mesh.vertices.emplace_back((mesh_from_row * Vector3(0.0, point.x(), point.y())).cast<float>());
  }
}

void JoinRows(std::size_t width, Mesh& mesh) {
  const auto base = static_cast<std::uint32_t>(mesh.vertices.size() - 2 * width);
  for (std::uint32_t i = 0; i + 1 < width; ++i) {
    const std::uint32_t near = base + i;
    const std::uint32_t far = near + static_cast<std::uint32_t>(width);
    mesh.triangles.push_back({near, far, far + 1});
    mesh.triangles.push_back({near, far + 1, near + 1});
  }
}

void AppendSweep(std::span<const Transform> mesh_from_station,
                 std::span<const Eigen::Vector2d> outline_m,
                 Mesh& mesh) {
  for (std::size_t k = 0; k < mesh_from_station.size(); ++k) {
    AppendRow(mesh_from_station[k], outline_m, mesh);
    if (k > 0) JoinRows(outline_m.size(), mesh);
  }
}

Mesh MeshOfGrid(std::span<const Vector3> points_m,
                std::size_t num_columns,
                const std::function<bool(std::size_t, std::size_t)>& keeps) {
  constexpr auto kUnused = std::numeric_limits<std::uint32_t>::max();
  Mesh mesh;
  std::vector<std::uint32_t> vertex_of_point(points_m.size(), kUnused);
  const auto vertex = [&](std::size_t row, std::size_t column) {
    const std::size_t point = row * num_columns + column;
    if (vertex_of_point[point] == kUnused) {
      vertex_of_point[point] = static_cast<std::uint32_t>(mesh.vertices.size());
      mesh.vertices.emplace_back(points_m[point].cast<float>());
    }
    return vertex_of_point[point];
  };
  for (std::size_t row = 0; (row + 2) * num_columns <= points_m.size(); ++row) {
    for (std::size_t column = 0; column + 1 < num_columns; ++column) {
      if (!keeps(row, column)) continue;
      const std::uint32_t right = vertex(row, column);
      const std::uint32_t left = vertex(row, column + 1);
      const std::uint32_t far_right = vertex(row + 1, column);
      const std::uint32_t far_left = vertex(row + 1, column + 1);
      mesh.triangles.push_back({right, far_right, far_left});
      mesh.triangles.push_back({right, far_left, left});
    }
  }
  return mesh;
}

Mesh MeshOfShown(std::span<const GridPoint> points,
                 std::size_t num_columns,
                 const std::function<bool(std::size_t, std::size_t)>& keeps) {
  std::vector<Vector3> places_m;
  for (const GridPoint& point : points) places_m.push_back(point.place_m);
  return MeshOfGrid(places_m, num_columns, [&](std::size_t row, std::size_t column) {
    const std::size_t corner = row * num_columns + column;
    const std::size_t ahead = corner + num_columns;
    return (points[corner].shows || points[corner + 1].shows || points[ahead].shows ||
            points[ahead + 1].shows) &&
           keeps(row, column);
  });
}

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
