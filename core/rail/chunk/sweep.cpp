#include "core/rail/chunk/sweep.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/error.h"

namespace railcast {
namespace {

/// Highest curvature of a line in plan and elevation combined, relative to a step of the axis'
/// chainage: the deviation of a chord over a step L is at most L^2 / 8 times it.
/// @param plan_per_m The part in plan, as a function of chainage.
template <typename Plan>
double StrongestCurvature_per_m(const Alignment& alignment,
                                const ChainageRange& range,
                                const Plan& plan_per_m) {
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
  return strongest_per_m;
}

std::vector<double> EvenStations(const ChainageRange& range,
                                 double curvature_per_m,
                                 double tolerance_m,
                                 double max_step_m) {
  const double step_m = std::min(max_step_m, std::sqrt(8.0 * tolerance_m / curvature_per_m));
  const double length_m = range.end_s_m - range.begin_s_m;
  const auto num_steps = static_cast<int>(std::ceil(length_m / step_m));
  std::vector<double> stations_m;
  for (int i = 0; i <= num_steps; ++i) {
    stations_m.push_back(range.begin_s_m + length_m * i / num_steps);
  }
  return stations_m;
}

}  // namespace

ChainageRange SweptRange(const ChunkContext& context, const TrackCourse& track) {
  return {.begin_s_m = std::max(context.begin_s_m - 0.5 * kChunkOverlap_m, track.begin_s_m()),
          .end_s_m = std::min(context.end_s_m + 0.5 * kChunkOverlap_m, track.end_s_m())};
}

std::vector<double> SweepStations(const Alignment& alignment,
                                  const ChainageRange& range,
                                  double offset_m,
                                  double tolerance_m,
                                  double max_step_m) {
  Check(range.begin_s_m < range.end_s_m, "a sweep has a length");
  // The line has the radius R - d and the chord L (R - d) / R, so that the sagitta is L^2 (1 - d /
  // R) / (8 R).
  const auto plan_per_m = [&](double s_m) {
    const double axis_per_m = alignment.At(s_m).curvature_per_m;
    return axis_per_m * (1.0 - axis_per_m * offset_m);
  };
  return EvenStations(range, StrongestCurvature_per_m(alignment, range, plan_per_m), tolerance_m,
                      max_step_m);
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
  Check(range.begin_s_m < range.end_s_m, "a sweep has a length");
  // A step of chainage is longer on the track by hypot(1 - kappa d, d').
  const auto plan_per_m = [&](double s_m) {
    const double axis_per_m = alignment.At(s_m).curvature_per_m;
    const TrackOffset offset = track.OffsetAt(s_m);
    const double stretch = std::hypot(1.0 - axis_per_m * offset.d_m, offset.slope);
    // That of its height, where it leaves the plane of another track.
    const double lift_per_m =
        track.LiftAt(alignment, s_m + 0.5).slope - track.LiftAt(alignment, s_m - 0.5).slope;
    return std::hypot(track.CurvatureAt(alignment, s_m) * stretch * stretch, lift_per_m);
  };
  return EvenStations(range, StrongestCurvature_per_m(alignment, range, plan_per_m), tolerance_m,
                      max_step_m);
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
