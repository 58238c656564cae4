#pragma once

#include <array>
#include <memory>
#include <optional>

#include "railcast/frame.h"
#include "railcast/scene.h"

namespace railcast {

using TriangleInSpace = std::array<Vector3, 3>;

/// The squared distance of a point to a triangle.
[[nodiscard]] double SquaredDistance_m2(const Vector3& point, const TriangleInSpace& triangle);

/// The distance of places to the surface of a mesh.
class MeshSurface {
 public:
  /// @pre The mesh has a triangle.
  explicit MeshSurface(const Mesh& mesh);
  ~MeshSurface();
  MeshSurface(const MeshSurface&) = delete;
  MeshSurface& operator=(const MeshSurface&) = delete;

  /// The greatest distance that the corners of `other`'s triangles and places between them have to
  /// this surface. Nothing if any point of `other` may be further away than the limit.
  ///
  /// A piece of a triangle whose corners are all near one triangle of this surface is nowhere
  /// further from it than at a corner, as a triangle is convex. Any other piece is cut in four
  /// until it is known to be within the limit. It counts as beyond where that is still unknown when
  /// no point of the piece is further from its middle than a sixteenth of the limit.
  [[nodiscard]] std::optional<double> DeviationWithin_m(const Mesh& other, double limit_m) const;

 private:
  struct Tree;
  std::unique_ptr<const Tree> tree_;
};

}  // namespace railcast
