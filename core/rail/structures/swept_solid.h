#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "core/rail/structures/structure_track.h"
#include "railcast/scene.h"
#include "railcast/transform.h"

namespace railcast {

/// Points (y, z) of a cross-section.
using Outline = std::vector<Eigen::Vector2d>;

/// A rectangle between two corners.
[[nodiscard]] Outline RectangleOutline(double y0_m, double z0_m, double y1_m, double z1_m);

/// Mirrors an outline that is drawn for the left, y outwards, to the side of that sign.
[[nodiscard]] Outline OnSide(Outline outline_m, double side);

/// Frames along the part of a structure that lies in a chunk, and which of the structure's ends do.
struct Stretch {
  std::vector<Transform> frames;
  bool has_begin{};
  bool has_end{};
};

/// The stretch of a structure in the chunk; nothing if it has none there.
/// @param d_m Where chords are at most 1 mm off: the part that is farthest out in curves.
/// @param frame_at The frame at a chainage.
[[nodiscard]] std::optional<Stretch> StretchInChunk(
    const StructureTrack& track,
    const ChainageRange& range,
    double d_m,
    const std::function<Transform(double s_m)>& frame_at);

/// Sweeps an open outline; it faces to the left of its direction, seen with y to the right.
void AppendSweptSheet(const Stretch& stretch,
                      std::span<const Eigen::Vector2d> outline_m,
                      Mesh& mesh);

/// Adds a closed outline as a face across the line.
void AppendSection(const Transform& frame, std::span<const Eigen::Vector2d> outline_m, Mesh& mesh);

/// Sweeps a closed outline, without repeating its first point, of any orientation; the surface
/// faces outwards and is closed where the structure begins or ends.
void AppendSweptSolid(const Stretch& stretch,
                      std::span<const Eigen::Vector2d> outline_m,
                      Mesh& mesh);

}  // namespace railcast
