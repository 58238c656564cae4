#pragma once

#include <memory>

#include "railcast/scene.h"

namespace railcast {

/// The distance of places to the surface of a mesh.
class MeshSurface {
 public:
  /// @pre The mesh has a triangle.
  explicit MeshSurface(const Mesh& mesh);
  ~MeshSurface();
  MeshSurface(const MeshSurface&) = delete;
  MeshSurface& operator=(const MeshSurface&) = delete;

  /// The greatest distance of any point of `other` to this surface, too small by `resolution_m` at
  /// most.
  ///
  /// A triangle of `other` whose corners are all near one triangle of this surface is nowhere
  /// further from it than at a corner, as a triangle is convex. Any other is cut in four until that
  /// is known well enough, or until its edges are as long as the resolution.
  [[nodiscard]] double DeviationOf_m(const Mesh& other, double resolution_m) const;

  /// Whether no point of `other` is further from this surface, an eighth of the limit at most
  /// granted: as DeviationOf_m(), but done as soon as that is known.
  [[nodiscard]] bool IsWithin(const Mesh& other, double limit_m) const;

 private:
  struct Tree;
  std::unique_ptr<const Tree> tree_;
};

}  // namespace railcast
