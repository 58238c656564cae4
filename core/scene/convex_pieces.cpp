#include "core/scene/convex_body.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>

#include "core/base/joined_sets.h"

namespace railcast {
namespace {

// Whether a body is convex takes time that grows with the square of their number.
constexpr std::size_t kMaxCorners = 5000;

using Triangle = std::array<Vector3, 3>;

using Corners = std::array<std::size_t, 3>;

/// Returns for every vertex the one that stands for all at the same place.
std::vector<std::size_t> PlacesOfVertices(const Mesh& mesh) {
  // Rounding may part what was one corner.
  constexpr double kSamePlace_per_m = 1e6;
  using Place = std::array<std::int64_t, 3>;
  std::vector<std::pair<Place, std::size_t>> sorted;
  for (const Eigen::Vector3f& vertex : mesh.vertices) {
    const Vector3 scaled = kSamePlace_per_m * vertex.cast<double>();
    sorted.push_back(
        {{std::llround(scaled.x()), std::llround(scaled.y()), std::llround(scaled.z())},
         sorted.size()});
  }
  std::ranges::sort(sorted);
  std::vector<std::size_t> places(sorted.size());
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    const bool is_same = i > 0 && sorted[i].first == sorted[i - 1].first;
    places[sorted[i].second] = is_same ? places[sorted[i - 1].second] : sorted[i].second;
  }
  return places;
}

/// Returns the triangles of a mesh by the places of their corners, gathered by what hangs
/// together. Triangles without area are left out.
std::vector<std::vector<Corners>> GatherPieces(const Mesh& mesh) {
  const std::vector<std::size_t> places = PlacesOfVertices(mesh);
  JoinedSets joined(mesh.vertices.size());
  std::vector<Corners> triangles;
  for (const auto& indices : mesh.triangles) {
    const Corners corners = {places[indices[0]], places[indices[1]], places[indices[2]]};
    if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) continue;
    joined.Join(corners[0], corners[1]);
    joined.Join(corners[0], corners[2]);
    triangles.push_back(corners);
  }
  std::map<std::size_t, std::vector<Corners>> pieces;
  for (const Corners& corners : triangles) pieces[joined.SetOf(corners[0])].push_back(corners);
  std::vector<std::vector<Corners>> list;
  for (auto& [set, piece] : pieces) list.push_back(std::move(piece));
  return list;
}

/// Whether every edge belongs to two triangles, so that the piece has an inside.
bool IsClosed(const std::vector<Corners>& piece) {
  std::vector<std::pair<std::size_t, std::size_t>> edges;
  for (const Corners& corners : piece) {
    for (std::size_t k = 0; k < 3; ++k) {
      edges.push_back(std::minmax({corners[k], corners[(k + 1) % 3]}));
    }
  }
  std::ranges::sort(edges);
  for (std::size_t i = 0; i < edges.size(); i += 2) {
    if (i + 1 == edges.size() || edges[i] != edges[i + 1]) return false;
    if (i + 2 < edges.size() && edges[i] == edges[i + 2]) return false;
  }
  return true;
}

std::vector<Triangle> TrianglesOfPiece(const std::vector<Corners>& piece, const Mesh& mesh) {
  std::vector<Triangle> triangles;
  for (const Corners& corners : piece) {
    Triangle& triangle = triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) triangle[k] = mesh.vertices[corners[k]].cast<double>();
  }
  return triangles;
}

std::vector<Vector3> CornersOfPiece(const std::vector<Triangle>& piece) {
  std::vector<Vector3> corners;
  for (const Triangle& triangle : piece) {
    corners.insert(corners.end(), triangle.begin(), triangle.end());
  }
  std::ranges::sort(corners, [](const Vector3& a, const Vector3& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
  });
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  return corners;
}

/// Whether all corners lie on one side of every triangle. Says nothing about the winding, so it
/// suits meshes that are wound inconsistently.
bool IsConvex(const std::vector<Triangle>& piece, const std::vector<Vector3>& corners) {
  return std::ranges::all_of(piece, [&](const Triangle& triangle) {
    const Vector3 across = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
    if (!(across.norm() > 0.0)) return true;
    const Vector3 normal = across.normalized();
    bool is_before = false;
    bool is_behind = false;
    for (const Vector3& corner : corners) {
      const double distance_m = normal.dot(corner - triangle[0]);
      is_before = is_before || distance_m > kConvexWithin_m;
      is_behind = is_behind || distance_m < -kConvexWithin_m;
      if (is_before && is_behind) return false;
    }
    return true;
  });
}

/// Whether a ray meets a triangle: Moeller and Trumbore, Fast, minimum storage ray-triangle
/// intersection, Journal of Graphics Tools 2 (1997).
bool Meets(const Triangle& triangle, const Vector3& origin, const Vector3& direction) {
  const Vector3 edge_1 = triangle[1] - triangle[0];
  const Vector3 edge_2 = triangle[2] - triangle[0];
  const Vector3 across = direction.cross(edge_2);
  const double determinant = edge_1.dot(across);
  if (determinant == 0.0) return false;
  const Vector3 from_corner = origin - triangle[0];
  const double u = from_corner.dot(across) / determinant;
  const Vector3 other = from_corner.cross(edge_1);
  const double v = direction.dot(other) / determinant;
  return u >= 0.0 && v >= 0.0 && u + v <= 1.0 && edge_2.dot(other) / determinant > 0.0;
}

}  // namespace

std::vector<Piece> PiecesOf(const Model& model) {
  std::vector<Piece> pieces;
  for (const Part& part : model.parts) {
    for (const std::vector<Corners>& gathered : GatherPieces(part.mesh)) {
      const std::vector<Triangle> triangles = TrianglesOfPiece(gathered, part.mesh);
      std::vector<Vector3> corners = CornersOfPiece(triangles);
      Piece& piece = pieces.emplace_back();
      for (const Vector3& corner : corners) piece.box_m.extend(corner);
      if (corners.size() <= kMaxCorners && IsClosed(gathered) && IsConvex(triangles, corners)) {
        piece.bodies.push_back(MakeConvexBody(std::move(corners)));
        continue;
      }
      for (const Triangle& triangle : triangles) {
        piece.bodies.push_back(MakeConvexBody({triangle.begin(), triangle.end()}));
      }
    }
  }
  return pieces;
}

bool Encloses(const Model& model, const Vector3& point_m) {
  std::array<bool, 6> is_met{};
  for (const Part& part : model.parts) {
    for (const auto& indices : part.mesh.triangles) {
      Triangle triangle;
      for (std::size_t k = 0; k < 3; ++k) {
        triangle[k] = part.mesh.vertices[indices[k]].cast<double>();
      }
      for (std::size_t i = 0; i < is_met.size(); ++i) {
        const double sign = i < 3 ? 1.0 : -1.0;
        const Vector3 direction = sign * Vector3::Unit(static_cast<Eigen::Index>(i % 3));
        is_met[i] = is_met[i] || Meets(triangle, point_m, direction);
      }
    }
  }
  return std::ranges::all_of(is_met, [](bool met) { return met; });
}

}  // namespace railcast
