#include "core/rail/track/sweep.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/error.h"

namespace railcast {
namespace {

/// Highest curvature of a line `offset_m` left of the axis, in plan and elevation combined,
/// relative to a step L of the axis' chainage: the line has the radius R - d and the chord L (R -
/// d) / R, so that the sagitta is L^2 (1 - d / R) / (8 R).
double StrongestCurvature_per_m(const Alignment& alignment,
                                const ChainageRange& range,
                                double offset_m) {
  constexpr double kSampling_m = 1.0;
  const double length_m = range.end_s_m - range.begin_s_m;
  const auto num_samples = static_cast<int>(std::ceil(length_m / kSampling_m)) + 1;
  double strongest_per_m = 0.0;
  for (int i = 0; i <= num_samples; ++i) {
    const double s_m = range.begin_s_m + length_m * i / num_samples;
    const double axis_per_m = alignment.At(s_m).curvature_per_m;
    const double plan_per_m = axis_per_m * (1.0 - axis_per_m * offset_m);
    // Beyond its ends, the line is level whatever the gradient at the end.
    const double before_s_m = std::max(0.0, s_m - 0.5 * kSampling_m);
    const double after_s_m = std::min(alignment.length_m(), s_m + 0.5 * kSampling_m);
    const double elevation_per_m =
        (alignment.At(after_s_m).gradient - alignment.At(before_s_m).gradient) / kSampling_m;
    strongest_per_m = std::max(strongest_per_m, std::hypot(plan_per_m, elevation_per_m));
  }
  return strongest_per_m;
}

}  // namespace

double TrackEnd_m(const TrackSpec& track, const Alignment& alignment) {
  return track.end_s_m.value_or(alignment.length_m());
}

ChainageRange SweptRange(const ChunkContext& context, const TrackSpec& track) {
  return {.begin_s_m = std::max(context.begin_s_m - 0.5 * kChunkOverlap_m, track.start_s_m),
          .end_s_m = std::min(context.end_s_m + 0.5 * kChunkOverlap_m,
                              TrackEnd_m(track, context.alignment))};
}

std::vector<double> SweepStations(const Alignment& alignment,
                                  const ChainageRange& range,
                                  double offset_m,
                                  double tolerance_m,
                                  double max_step_m) {
  Check(range.begin_s_m < range.end_s_m, "a sweep has a length");
  const double curvature_per_m = StrongestCurvature_per_m(alignment, range, offset_m);
  const double step_m = std::min(max_step_m, std::sqrt(8.0 * tolerance_m / curvature_per_m));
  const double length_m = range.end_s_m - range.begin_s_m;
  const auto num_steps = static_cast<int>(std::ceil(length_m / step_m));
  std::vector<double> stations_m;
  for (int i = 0; i <= num_steps; ++i) {
    stations_m.push_back(range.begin_s_m + length_m * i / num_steps);
  }
  return stations_m;
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

void AppendSweep(std::span<const Transform> mesh_from_station,
                 std::span<const Eigen::Vector2d> outline_m,
                 Mesh& mesh) {
  const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
  const auto width = static_cast<std::uint32_t>(outline_m.size());
  for (const Transform& station : mesh_from_station) {
    for (const Eigen::Vector2d& point : outline_m) {
      mesh.vertices.emplace_back((station * Vector3(0.0, point.x(), point.y())).cast<float>());
    }
  }
  for (std::uint32_t k = 0; k + 1 < mesh_from_station.size(); ++k) {
    for (std::uint32_t i = 0; i + 1 < width; ++i) {
      const std::uint32_t near = base + k * width + i;
      const std::uint32_t far = near + width;
      mesh.triangles.push_back({near, far, far + 1});
      mesh.triangles.push_back({near, far + 1, near + 1});
    }
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

}  // namespace railcast
