#pragma once

#include <vector>

#include "core/scene/convex_body.h"
#include "railcast/scene.h"

namespace railcast {

/// A closed surface counts as convex if no corner of it lies farther beyond the plane of any of its
/// triangles, as on limbs and on wheels with flanges.
inline constexpr double kConvexWithin_m = 0.01;

/// Triangles of a model that hang together, such as a plank of a wagon, in the model's frame.
struct Piece {
  Eigen::AlignedBox3d box_m;
  /// One body if the piece is closed and convex and has at most 5,000 corners; otherwise one for
  /// each of its triangles: it counts as hollow.
  std::vector<ConvexBody> bodies;
};

/// The pieces of a model. Triangles that share a corner belong to one piece.
[[nodiscard]] std::vector<Piece> PiecesOf(const Model& model);

/// Whether a model surrounds a point in its frame: the six rays along its axes all meet it.
[[nodiscard]] bool Encloses(const Model& model, const Vector3& point_m);

}  // namespace railcast
