#include "tests/bench/mesh_deviation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <unsupported/Eigen/BVH>
#include <utility>
#include <vector>

namespace railcast {
namespace {

using Corners = std::array<Vector3, 3>;

/// A triangle with its box, for Eigen's tree, which finds the box by the function's name.
struct BoxedTriangle {
  Corners corners;
  Eigen::AlignedBox3d box_m;

  // NOLINTNEXTLINE(readability-identifier-naming): a name that Eigen asks for
  friend Eigen::AlignedBox3d bounding_box(const BoxedTriangle& triangle) { return triangle.box_m; }
};

/// The squared distance of a point to a stretch.
double SquaredToEdge_m2(const Vector3& point, const Vector3& a, const Vector3& b) {
  const Vector3 ab = b - a;
  const double length2_m2 = ab.squaredNorm();
  const double along = length2_m2 > 0.0 ? std::clamp(ab.dot(point - a) / length2_m2, 0.0, 1.0) : 0;
  return (point - a - along * ab).squaredNorm();
}

double Squared_m2(const Vector3& point, const Corners& triangle) {
  const auto& [a, b, c] = triangle;
  const Vector3 normal = (b - a).cross(c - a);
  const double normal2 = normal.squaredNorm();
  const auto is_inside = [&](const Vector3& from, const Vector3& to) {
    return (to - from).cross(point - from).dot(normal) >= 0.0;
  };
  if (normal2 > 0.0 && is_inside(a, b) && is_inside(b, c) && is_inside(c, a)) {
    const double height = normal.dot(point - a);
    return height * height / normal2;
  }
  return std::min({SquaredToEdge_m2(point, a, b), SquaredToEdge_m2(point, b, c),
                   SquaredToEdge_m2(point, c, a)});
}

/// Finds the triangle of a tree that is nearest to a point.
class NearestTriangle {
 public:
  using Scalar = double;

  explicit NearestTriangle(const Vector3& point) : point_(point) {}

  // NOLINTBEGIN(readability-identifier-naming): names that Eigen asks for
  [[nodiscard]] double minimumOnVolume(const Eigen::AlignedBox3d& box_m) const {
    return box_m.squaredExteriorDistance(point_);
  }
  double minimumOnObject(const BoxedTriangle& triangle) {
    const double squared_m2 = Squared_m2(point_, triangle.corners);
    if (squared_m2 < least_m2_) {
      least_m2_ = squared_m2;
      nearest_ = &triangle;
    }
    return squared_m2;
  }
  // NOLINTEND(readability-identifier-naming)

  [[nodiscard]] const BoxedTriangle* nearest() const { return nearest_; }
  [[nodiscard]] double least_m() const { return std::sqrt(least_m2_); }

 private:
  const Vector3& point_;
  const BoxedTriangle* nearest_ = nullptr;
  double least_m2_ = std::numeric_limits<double>::infinity();
};

Corners SpanOf(const Mesh& mesh, const std::array<std::uint32_t, 3>& triangle) {
  return {mesh.vertices[triangle[0]].cast<double>(), mesh.vertices[triangle[1]].cast<double>(),
          mesh.vertices[triangle[2]].cast<double>()};
}

/// When a search for the deviation goes no further.
struct Search {
  double resolution_m{};
  double pass_m = 0.0;  ///< A triangle that deviates by no more than this needs no closer look.
  double enough_m = std::numeric_limits<double>::infinity();  ///< More need not be found.
};

}  // namespace

struct MeshSurface::Tree {
  Eigen::KdBVH<double, 3, BoxedTriangle> boxes;

  [[nodiscard]] NearestTriangle NearestTo(const Vector3& point) const {
    NearestTriangle nearest(point);
    Eigen::BVMinimize(boxes, nearest);
    return nearest;
  }

  /// Raises `found_m` to the deviation of a triangle, until it is more than `enough_m`.
  void Measure(const Corners& piece, const Search& search, double& found_m) const {
    const auto& [a, b, c] = piece;
    const NearestTriangle at_middle = NearestTo((a + b + c) / 3.0);
    found_m = std::max(found_m, at_middle.least_m());
    double at_most_m = 0.0;
    for (const Vector3& corner : piece) {
      at_most_m = std::max(at_most_m, std::sqrt(Squared_m2(corner, at_middle.nearest()->corners)));
    }
    const double edge_m = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
    const double passed_m = std::max(found_m + search.resolution_m, search.pass_m);
    if (at_most_m <= passed_m || edge_m <= search.resolution_m || found_m > search.enough_m) return;
    const Vector3 ab = 0.5 * (a + b);
    const Vector3 bc = 0.5 * (b + c);
    const Vector3 ca = 0.5 * (c + a);
    for (const Corners& quarter :
         {Corners{a, ab, ca}, Corners{ab, b, bc}, Corners{ca, bc, c}, Corners{ab, bc, ca}}) {
      Measure(quarter, search, found_m);
    }
  }

  [[nodiscard]] double Measure(const Mesh& other, const Search& search) const {
    double found_m = 0.0;
    for (const auto& triangle : other.triangles) {
      Measure(SpanOf(other, triangle), search, found_m);
      if (found_m > search.enough_m) break;
    }
    return found_m;
  }
};

MeshSurface::MeshSurface(const Mesh& mesh) {
  std::vector<BoxedTriangle> triangles;
  for (const auto& triangle : mesh.triangles) {
    BoxedTriangle boxed{.corners = SpanOf(mesh, triangle), .box_m = {}};
    for (const Vector3& corner : boxed.corners) boxed.box_m.extend(corner);
    triangles.push_back(boxed);
  }
  // Eigen's tree finds nothing among fewer than two.
  if (triangles.size() == 1) triangles.push_back(triangles.front());
  auto tree = std::make_unique<Tree>();
  tree->boxes.init(triangles.begin(), triangles.end());
  tree_ = std::move(tree);
}

MeshSurface::~MeshSurface() = default;

double MeshSurface::DeviationOf_m(const Mesh& other, double resolution_m) const {
  return tree_->Measure(other, {.resolution_m = resolution_m});
}

bool MeshSurface::IsWithin(const Mesh& other, double limit_m) const {
  const Search search{.resolution_m = limit_m / 8.0, .pass_m = limit_m, .enough_m = limit_m};
  return tree_->Measure(other, search) <= limit_m;
}

}  // namespace railcast
