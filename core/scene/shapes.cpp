#include "core/scene/shapes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/base/error.h"
#include "core/scene/polygon.h"
#include "core/scene/rotation_between.h"

namespace railcast {
namespace {

/// Vertices of one cross-section: a circle of `count` vertices starting at `first`, or a single
/// point.
struct Ring {
  std::uint32_t first{};
  std::uint32_t count{};
};

std::uint32_t AddVertex(const Vector3& position_m, Mesh& mesh) {
  mesh.vertices.emplace_back(position_m.cast<float>());
  return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
}

/// Adds the wall between two rings. `b` lies ahead of `a` along the axis about which the rings turn
/// left.
void AddWall(const Ring& a, const Ring& b, Mesh& mesh) {
  const std::uint32_t count = std::max(a.count, b.count);
  for (std::uint32_t i = 0; i < count && count > 1; ++i) {
    const std::uint32_t next = (i + 1) % count;
    if (a.count == 1) {
      mesh.triangles.push_back({a.first, b.first + next, b.first + i});
    } else if (b.count == 1) {
      mesh.triangles.push_back({a.first + i, a.first + next, b.first});
    } else {
      mesh.triangles.push_back({a.first + i, a.first + next, b.first + next});
      mesh.triangles.push_back({a.first + i, b.first + next, b.first + i});
    }
  }
}

void AddCap(const Ring& ring, bool faces_ahead, Mesh& mesh) {
  for (std::uint32_t i = 1; i + 1 < ring.count; ++i) {
    const std::uint32_t b = ring.first + (faces_ahead ? i : i + 1);
    const std::uint32_t c = ring.first + (faces_ahead ? i + 1 : i);
    mesh.triangles.push_back({ring.first, b, c});
  }
}

Vector3 AnyPerpendicular(const Vector3& direction) {
  const Vector3 other = std::abs(direction.z()) < 0.9 ? Vector3::UnitZ() : Vector3::UnitX();
  return direction.cross(other).cross(direction).normalized();
}

double Angle(int i, int num_sides) {
  return 2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(num_sides);
}

}  // namespace

Mesh MakeBox(const Eigen::AlignedBox3d& box) {
  Check((box.sizes().array() > 0.0).all(), "a box has a positive size");
  Mesh mesh;
  for (int i = 0; i < 8; ++i) {
    AddVertex(box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i)), mesh);
  }
  // Corner i has its maximum x, y or z where bit 0, 1 or 2 of i is set.
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

Mesh MakeTube(std::span<const Vector3> centreline, double radius_m, int num_sides) {
  const std::vector<double> radii_m(centreline.size(), radius_m);
  return MakeTube(centreline, radii_m, num_sides);
}

Mesh MakeTube(std::span<const Vector3> centreline, std::span<const double> radii_m, int num_sides) {
  const std::size_t num_points = centreline.size();
  Check(num_points >= 2 && radii_m.size() == num_points && num_sides >= 3, "a tube has a section");
  constexpr double kLeastCosineOfHalfATurn = 0.2588;  // 75 degrees.
  Mesh mesh;
  Vector3 direction = (centreline[1] - centreline[0]).normalized();
  Vector3 u = AnyPerpendicular(direction);
  Ring previous;
  for (std::size_t point = 0; point < num_points; ++point) {
    const bool last = point + 1 == num_points;
    const Vector3 next_direction =
        last ? direction : Vector3((centreline[point + 1] - centreline[point]).normalized());
    const Vector3 mitre_normal = (direction + next_direction).normalized();
    const double cosine = mitre_normal.dot(direction);
    Check(cosine > kLeastCosineOfHalfATurn, "a tube turns by less than 150 degrees");
    const Vector3 v = direction.cross(u);
    const Ring ring{static_cast<std::uint32_t>(mesh.vertices.size()),
                    static_cast<std::uint32_t>(num_sides)};
    for (int side = 0; side < num_sides; ++side) {
      const double angle_rad = Angle(side, num_sides);
      const Vector3 spoke = radii_m[point] * (std::cos(angle_rad) * u + std::sin(angle_rad) * v);
      // Slide along the piece that ends here onto the plane that bisects the bend. By symmetry, the
      // piece that begins here meets that plane in the same points.
      AddVertex(centreline[point] + spoke - direction * (spoke.dot(mitre_normal) / cosine), mesh);
    }
    if (point == 0) AddCap(ring, false, mesh);
    if (point > 0) AddWall(previous, ring, mesh);
    if (last) AddCap(ring, true, mesh);
    previous = ring;
    u = RotationBetween(direction, next_direction) * u;
    u = (u - next_direction * u.dot(next_direction)).normalized();
    direction = next_direction;
  }
  return mesh;
}

Mesh MakeLathe(std::span<const Eigen::Vector2d> profile, int num_sides) {
  Check(profile.size() >= 2 && num_sides >= 3, "a lathe has a profile");
  Mesh mesh;
  Ring previous;
  for (std::size_t point = 0; point < profile.size(); ++point) {
    const double x_m = profile[point].x();
    const double radius_m = profile[point].y();
    Ring ring{static_cast<std::uint32_t>(mesh.vertices.size()),
              radius_m > 0.0 ? static_cast<std::uint32_t>(num_sides) : 1U};
    for (int side = 0; side < static_cast<int>(ring.count); ++side) {
      const double angle_rad = Angle(side, num_sides);
      AddVertex({x_m, radius_m * std::cos(angle_rad), radius_m * std::sin(angle_rad)}, mesh);
    }
    if (point == 0) AddCap(ring, false, mesh);
    if (point > 0) AddWall(previous, ring, mesh);
    if (point + 1 == profile.size()) AddCap(ring, true, mesh);
    previous = ring;
  }
  return mesh;
}

Mesh MakeExtrusion(std::span<const Eigen::Vector2d> outline, double begin_x_m, double end_x_m) {
  Check(outline.size() >= 3 && begin_x_m < end_x_m, "an extrusion has a volume");
  double twice_area = 0.0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Eigen::Vector2d& a = outline[i];
    const Eigen::Vector2d& b = outline[(i + 1) % outline.size()];
    twice_area += a.x() * b.y() - a.y() * b.x();
  }
  std::vector<Eigen::Vector2d> left_turning(outline.begin(), outline.end());
  if (twice_area < 0.0) left_turning.assign(outline.rbegin(), outline.rend());

  Mesh mesh;
  const auto count = static_cast<std::uint32_t>(outline.size());
  for (const double x_m : {begin_x_m, end_x_m}) {
    for (const Eigen::Vector2d& yz : left_turning) AddVertex({x_m, yz.x(), yz.y()}, mesh);
  }
  AddWall({0, count}, {count, count}, mesh);
  for (const auto& [a, b, c] : TriangulatePolygon(left_turning)) {
    mesh.triangles.push_back({a, c, b});
    mesh.triangles.push_back({a + count, b + count, c + count});
  }
  return mesh;
}

Mesh MakeEllipsoid(const Vector3& centre_m, const Vector3& half_axes_m, int num_sides) {
  const int num_rings = num_sides / 2;
  std::vector<Eigen::Vector2d> profile;
  for (int ring = 0; ring <= num_rings; ++ring) {
    const double angle_rad = std::numbers::pi * ring / num_rings;
    const bool pole = ring == 0 || ring == num_rings;
    profile.emplace_back(-std::cos(angle_rad), pole ? 0.0 : std::sin(angle_rad));
  }
  Mesh mesh = MakeLathe(profile, num_sides);
  // The lathe revolves about x; rotate so that the poles are at the top and bottom.
  for (Eigen::Vector3f& vertex : mesh.vertices) {
    const Eigen::Vector3f unit(vertex.y(), vertex.z(), vertex.x());
    vertex = (centre_m + half_axes_m.cwiseProduct(unit.cast<double>())).cast<float>();
  }
  return mesh;
}

}  // namespace railcast
