#pragma once

#include <vector>

#include "railcast/scene.h"
#include "railcast/transform.h"

namespace railcast {

/// The convex hull of some corners, in metres: a box, a prism, a triangle.
struct ConvexBody {
  std::vector<Vector3> corners_m;
  Eigen::AlignedBox3d box_m;  ///< Around the corners, along the axes of their frame.
  bool is_box{};              ///< Whether the corners are those of `box_m`.
};

/// @pre At least one corner.
[[nodiscard]] ConvexBody MakeConvexBody(std::vector<Vector3> corners_m);

/// The gap between two bodies, or `reach_m` where it is wider. 0 where they meet.
///
/// Gilbert, Johnson and Keerthi, A fast procedure for computing the distance between complex
/// objects in three-dimensional space, IEEE J. Robotics and Automation 4 (1988). Exact to 1e-6 m.
[[nodiscard]] double Gap_m(const ConvexBody& one,
                           const Transform& one_from_other,
                           const ConvexBody& other,
                           double reach_m);

/// The length of the shortest straight move that parts two bodies which meet, or `least_m` where it
/// is shorter.
///
/// The move is sought along the axes of both frames and their cross products, which is exact for
/// boxes along these axes (separating axis theorem). For other bodies it is also sought in 200
/// directions all around and along the line through the centres, and the best is refined; the
/// result may be too large, never too small.
[[nodiscard]] double Depth_m(const ConvexBody& one,
                             const Transform& one_from_other,
                             const ConvexBody& other,
                             double least_m = 0.0);

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
