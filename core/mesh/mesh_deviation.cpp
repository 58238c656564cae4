#include "core/mesh/mesh_deviation.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>
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

/// A triangle with its box, for Eigen's tree, which finds the box by the function's name.
struct BoxedTriangle {
  TriangleInSpace corners;
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
    const double squared_m2 = SquaredDistance_m2(point_, triangle.corners);
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

TriangleInSpace SpanOf(const Mesh& mesh, const std::array<std::uint32_t, 3>& triangle) {
  return {mesh.vertices[triangle[0]].cast<double>(), mesh.vertices[triangle[1]].cast<double>(),
          mesh.vertices[triangle[2]].cast<double>()};
}

}  // namespace

double SquaredDistance_m2(const Vector3& point, const TriangleInSpace& triangle) {
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

struct MeshSurface::Tree {
  Eigen::KdBVH<double, 3, BoxedTriangle> boxes;

  [[nodiscard]] NearestTriangle NearestTo(const Vector3& point) const {
    NearestTriangle nearest(point);
    Eigen::BVMinimize(boxes, nearest);
    return nearest;
  }

  /// Raises `found_m` to the deviation of a piece of a triangle.
  /// @return Whether all of the piece is within the limit.
  [[nodiscard]] bool Measure(const TriangleInSpace& piece, double limit_m, double& found_m) const {
    const auto& [a, b, c] = piece;
    const Vector3 middle = (a + b + c) / 3.0;
    const NearestTriangle at_middle = NearestTo(middle);
    found_m = std::max(found_m, at_middle.least_m());
    if (found_m > limit_m) return false;
    double at_most_m = 0.0;
    double reach_m = 0.0;
    for (const Vector3& corner : piece) {
      at_most_m =
          std::max(at_most_m, std::sqrt(SquaredDistance_m2(corner, at_middle.nearest()->corners)));
      reach_m = std::max(reach_m, (corner - middle).norm());
    }
    if (std::min(at_most_m, at_middle.least_m() + reach_m) <= limit_m) return true;
    if (reach_m <= limit_m / 16.0) return false;
    const Vector3 ab = 0.5 * (a + b);
    const Vector3 bc = 0.5 * (b + c);
    const Vector3 ca = 0.5 * (c + a);
    return Measure({a, ab, ca}, limit_m, found_m) && Measure({ab, b, bc}, limit_m, found_m) &&
           Measure({ca, bc, c}, limit_m, found_m) && Measure({ab, bc, ca}, limit_m, found_m);
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

std::optional<double> MeshSurface::DeviationWithin_m(const Mesh& other, double limit_m) const {
  constexpr double kBeyond = std::numeric_limits<double>::infinity();
  const auto deviation_of = [&](const std::array<std::uint32_t, 3>& triangle) {
    const TriangleInSpace corners = SpanOf(other, triangle);
    double found_m = 0.0;
    for (const Vector3& corner : corners) {
      found_m = std::max(found_m, tree_->NearestTo(corner).least_m());
    }
    return tree_->Measure(corners, limit_m, found_m) ? found_m : kBeyond;
  };
  const auto most_of = [&](const tbb::blocked_range<std::size_t>& range, double most_m) {
    for (std::size_t t = range.begin(); t != range.end() && most_m <= limit_m; ++t) {
      most_m = std::max(most_m, deviation_of(other.triangles[t]));
    }
    return most_m;
  };
  const double most_m =
      tbb::parallel_reduce(tbb::blocked_range<std::size_t>(0, other.triangles.size()), 0.0, most_of,
                           [](double one_m, double two_m) { return std::max(one_m, two_m); });
  if (most_m > limit_m) return std::nullopt;
  return most_m;
}

}  // namespace railcast
