#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/rail/chunk/chunk_context.h"
#include "core/rail/chunk/sweep.h"
#include "core/rail/network/world_tracks.h"
#include "railcast/scene.h"
#include "railcast/structures.h"
#include "railcast/transform.h"

namespace railcast {

/// The frames of the track along which a structure runs, in the frame of a chunk.
class StructureTrack {
 public:
  /// @pre The world has a track of that name.
  StructureTrack(const ChunkContext& context, const std::string& track);

  [[nodiscard]] const TrackSpec& spec() const { return *track_; }
  [[nodiscard]] double offset_m(double s_m) const { return course_->OffsetAt(s_m).d_m; }
  [[nodiscard]] const TrackCourse& course() const { return *course_; }

  /// Origin on the track's axis at top of rail, x along the track, y in the plane of the rails.
  [[nodiscard]] Transform Canted(double s_m) const;
  /// The same origin and heading, but z vertical and y level, for what stands upright.
  [[nodiscard]] Transform Upright(double s_m) const;
  /// Upright, with its origin at `d_m`, `h_m` of the canted frame: for what follows the rails but
  /// stands upright, such as the edge of a platform.
  [[nodiscard]] Transform UprightAt(double s_m, double d_m, double h_m) const;

  /// The part of a stretch that the chunk's swept surfaces cover, with half the overlap at either
  /// end; nothing if the stretch has no part in the chunk.
  [[nodiscard]] std::optional<ChainageRange> InChunk(const ChainageRange& stretch) const;
  /// Chainages between which a chord `d_m` left of the track's axis is at most 1 mm off, and at
  /// most `max_step_m` long. 2.5 m also meets a kink of 1:400 in a cant ramp within 1 mm.
  [[nodiscard]] std::vector<double> Stations(const ChainageRange& range,
                                             double d_m,
                                             double max_step_m = 2.5) const;
  /// Where repeated parts stand that belong to the chunk, evenly spaced from the stretch's begin to
  /// its end and at most `spacing_m` apart.
  [[nodiscard]] std::vector<double> Places(const ChainageRange& stretch, double spacing_m) const;
  /// Whether `s_m` belongs to the chunk: the end of the line to the last.
  [[nodiscard]] bool Holds(double s_m) const;

 private:
  const ChunkContext* context_;
  const TrackSpec* track_;
  const TrackCourse* course_;
};

/// Points (y, z) of a cross-section.
using Outline = std::vector<Eigen::Vector2d>;

/// Twice the area of a closed outline, whose first point is not repeated; negative if it turns
/// right.
[[nodiscard]] double TwiceAreaOf(std::span<const Eigen::Vector2d> outline_m);

/// A rectangle between two corners.
[[nodiscard]] Outline RectangleOutline(double y0_m, double z0_m, double y1_m, double z1_m);

/// Mirrors an outline that is drawn for the left, y outwards, to the side of that sign.
[[nodiscard]] Outline OnSide(Outline outline_m, double side);

[[nodiscard]] inline ChainageRange RangeOf(const StretchSpec& stretch) {
  return {.begin_s_m = stretch.begin_s_m, .end_s_m = stretch.end_s_m};
}

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

/// Adds a closed outline as a face across the line.
void AppendSection(const Transform& frame, std::span<const Eigen::Vector2d> outline_m, Mesh& mesh);

/// Sweeps a closed outline, without repeating its first point, of any orientation; the surface
/// faces outwards and is closed where the structure begins or ends.
void AppendSweptSolid(const Stretch& stretch,
                      std::span<const Eigen::Vector2d> outline_m,
                      Mesh& mesh);

}  // namespace railcast
