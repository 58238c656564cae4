#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <limits>
#include <span>

#include "railcast/scene.h"

namespace railcast {

template <typename Real>
struct TriangleHit {
  Real range_m = std::numeric_limits<Real>::infinity();  ///< Infinite: nothing was hit.
  std::uint32_t part{};                                  ///< Index into the parts.
  Eigen::Matrix<Real, 3, 1> normal{0, 0, 0};             ///< As wound; not normalised.
};

/// Finds the first triangle along a ray by testing each in turn: Moeller and Trumbore 1997, "Fast,
/// minimum storage ray-triangle intersection". In double it is the slow, simple reference; in float
/// it is what a simple simulator does. Vertices are moved by `frame_from_model` before the search.
/// @param only_front Whether triangles seen from behind are skipped, as renderers do.
template <typename Real>
[[nodiscard]] TriangleHit<Real> SearchTriangles(
    std::span<const Part> parts,
    const Eigen::Transform<Real, 3, Eigen::Isometry>& frame_from_model,
    const Eigen::Matrix<Real, 3, 1>& origin_m,
    const Eigen::Matrix<Real, 3, 1>& direction,
    bool only_front = false) {
  using Vector = Eigen::Matrix<Real, 3, 1>;
  // The ray is moved into the model's frame once, instead of moving every vertex.
  const auto model_from_frame = frame_from_model.inverse();
  const Vector origin = model_from_frame * origin_m;
  const Vector along = model_from_frame.linear() * direction;
  TriangleHit<Real> best;
  for (std::uint32_t part = 0; part < parts.size(); ++part) {
    const Mesh& mesh = parts[part].mesh;
    for (const auto& [a, b, c] : mesh.triangles) {
      const Vector corner = mesh.vertices[a].template cast<Real>();
      const Vector edge_1 = mesh.vertices[b].template cast<Real>() - corner;
      const Vector edge_2 = mesh.vertices[c].template cast<Real>() - corner;
      const Vector p = along.cross(edge_2);
      const Real determinant = edge_1.dot(p);
      if (determinant == Real(0) || (only_front && determinant < Real(0))) continue;
      const Vector from_corner = origin - corner;
      const Real u = from_corner.dot(p) / determinant;
      if (!(u >= Real(0) && u <= Real(1))) continue;
      const Vector q = from_corner.cross(edge_1);
      const Real v = along.dot(q) / determinant;
      if (!(v >= Real(0) && u + v <= Real(1))) continue;
      const Real range_m = edge_2.dot(q) / determinant;
      if (!(range_m >= Real(0) && range_m < best.range_m)) continue;
      best = {range_m, part, frame_from_model.linear() * edge_1.cross(edge_2)};
    }
  }
  return best;
}

}  // namespace railcast
