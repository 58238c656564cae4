#pragma once

#include <Eigen/Core>
#include <functional>
#include <span>
#include <vector>

#include "core/rail/base/chainage_range.h"
#include "core/rail/chunk/chunk_context.h"
#include "railcast/scene.h"
#include "railcast/transform.h"

namespace railcast {

/// The range of a track that a chunk's swept surfaces cover: the chunk with half the overlap at
/// either end, or less where the track begins or ends. If the track does not extend into the chunk,
/// the range ends before it begins.
[[nodiscard]] ChainageRange SweptRange(const ChunkContext& context, const TrackCourse& track);

/// Evenly spaced chainages over the range, such that chords between neighbours deviate from a line
/// `offset_m` left of the axis by at most `tolerance_m`. From the sagitta L^2 kappa / 8 at the
/// highest curvature in the range, in plan and elevation combined, the spacing is at most L =
/// sqrt(8 tolerance / kappa), and never more than `max_step_m`.
[[nodiscard]] std::vector<double> SweepStations(const Alignment& alignment,
                                                const ChainageRange& range,
                                                double offset_m,
                                                double tolerance_m,
                                                double max_step_m);

/// As above, for the axis of a track.
[[nodiscard]] std::vector<double> SweepStations(const Alignment& alignment,
                                                const ChainageRange& range,
                                                const TrackCourse& track,
                                                double tolerance_m,
                                                double max_step_m);

/// The integer multiples of `step_m` in the range, and the ends of the range. A multiple closer to
/// an end than a quarter of a step is dropped.
[[nodiscard]] std::vector<double> GridStations(const ChainageRange& range, double step_m);

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

}  // namespace railcast
