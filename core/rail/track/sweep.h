#pragma once

#include <Eigen/Core>
#include <functional>
#include <span>
#include <vector>

#include "core/base/transform.h"
#include "core/rail/chunk_context.h"
#include "core/scene/mesh.h"

namespace railcast {

/// A stretch of the line.
struct ChainageRange {
  double begin_s_m{};
  double end_s_m{};
};

/// What of `track` a chunk's swept surfaces cover: the chunk with half the overlap at either end,
/// or less where the track begins or ends; ends before it begins where the track is elsewhere.
[[nodiscard]] ChainageRange SweptRange(const ChunkContext& context, const TrackSpec& track);

/// Where the track ends: its own figure or the line's end.
[[nodiscard]] double TrackEnd_m(const TrackSpec& track, const Alignment& alignment);

/// Chainages from end to end of the range, evenly spaced, so that a chord between neighbours is off
/// a line `offset_m` left of the axis by at most `tolerance_m`: the sagitta L^2 kappa / 8 of the
/// strongest curvature in the range, in plan and elevation together, gives
/// L = sqrt(8 tolerance / kappa), and never more than `max_step_m`.
[[nodiscard]] std::vector<double> SweepStations(const Alignment& alignment,
                                                const ChainageRange& range,
                                                double offset_m,
                                                double tolerance_m,
                                                double max_step_m);

/// The whole multiples of `step_m` in the range, and the range's ends. A multiple nearer to an end
/// than a quarter of a step gives way to it.
[[nodiscard]] std::vector<double> GridStations(const ChainageRange& range, double step_m);

/// Draws an open outline of (y, z) points along a row of frames (x forward). Outside is to the left
/// of the outline's direction on paper with y to the right and z up: clockwise outlines face
/// outwards.
void AppendSweep(std::span<const Transform> mesh_from_station,
                 std::span<const Eigen::Vector2d> outline_m,
                 Mesh& mesh);

/// Triangles over a grid of points, row by row, for the cells that `keeps(row, column)` (of their
/// first corner) names. Rows run forward and columns to the left, so that the surface faces up.
/// Points of no kept cell are left out.
[[nodiscard]] Mesh MeshOfGrid(std::span<const Vector3> points_m,
                              std::size_t num_columns,
                              const std::function<bool(std::size_t, std::size_t)>& keeps);

}  // namespace railcast
