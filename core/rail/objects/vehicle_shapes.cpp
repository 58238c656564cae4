#include "core/rail/objects/vehicle_shapes.h"

#include <cstdint>
#include <utility>

#include "core/base/error.h"

namespace railcast {
namespace {

std::uint32_t AddCorner(const Vector3& position_m, Mesh& mesh) {
  mesh.vertices.emplace_back(position_m.cast<float>());
  return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
}

/// Closes one end by a fan about the mean of its corners.
void AddLoftEnd(const VehicleSection& section, std::uint32_t first, bool is_last, Mesh& mesh) {
  Vector3 mean = Vector3::Zero();
  for (const Vector3& corner : section) mean += corner / static_cast<double>(section.size());
  const std::uint32_t middle = AddCorner(mean, mesh);
  const auto count = static_cast<std::uint32_t>(section.size());
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t a = first + i;
    const std::uint32_t b = first + (i + 1) % count;
    if (is_last) {
      mesh.triangles.push_back({middle, a, b});
    } else {
      mesh.triangles.push_back({middle, b, a});
    }
  }
}

double SignedVolume_m3(const Mesh& mesh) {
  double volume_m3 = 0.0;
  const Vector3 origin = mesh.vertices.front().cast<double>();
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vector3 pa = mesh.vertices[a].cast<double>() - origin;
    const Vector3 pb = mesh.vertices[b].cast<double>() - origin;
    const Vector3 pc = mesh.vertices[c].cast<double>() - origin;
    volume_m3 += pa.dot(pb.cross(pc)) / 6.0;
  }
  return volume_m3;
}

}  // namespace

VehicleSection MakeVehicleSection(double x_m, std::span<const Eigen::Vector2d> left_half) {
  VehicleSection section;
  for (const Eigen::Vector2d& point : left_half) section.emplace_back(x_m, point.x(), point.y());
  for (auto point = left_half.rbegin(); point != left_half.rend(); ++point) {
    if (point->x() > 0.0) section.emplace_back(x_m, -point->x(), point->y());
  }
  return section;
}

Mesh MakeLoft(std::span<const VehicleSection> sections) {
  Check(sections.size() >= 2 && sections.front().size() >= 3, "a loft has two sections");
  Mesh mesh;
  const auto count = static_cast<std::uint32_t>(sections.front().size());
  for (const VehicleSection& section : sections) {
    Check(section.size() == count, "the sections of a loft have equally many corners");
    for (const Vector3& corner : section) AddCorner(corner, mesh);
  }
  for (std::uint32_t k = 0; k + 1 < sections.size(); ++k) {
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint32_t a = k * count + i;
      const std::uint32_t b = k * count + (i + 1) % count;
      mesh.triangles.push_back({a, b, b + count});
      mesh.triangles.push_back({a, b + count, a + count});
    }
  }
  AddLoftEnd(sections.front(), 0, false, mesh);
  AddLoftEnd(sections.back(), static_cast<std::uint32_t>(sections.size() - 1) * count, true, mesh);
  if (SignedVolume_m3(mesh) < 0.0) {
    for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  }
  return mesh;
}

Mesh MakePane(const std::array<Vector3, 4>& corners_m,
              const FacePart& part,
              const Vector3& outwards,
              double proud_m) {
  constexpr double kDepth_m = 0.03;
  const auto at = [&](double u, double v) -> Vector3 {
    const Vector3 on_first = corners_m[0] + u * (corners_m[1] - corners_m[0]);
    const Vector3 on_last = corners_m[3] + u * (corners_m[2] - corners_m[3]);
    return on_first + v * (on_last - on_first);
  };
  const VehicleSection face = {at(part.begin_u, part.begin_v), at(part.end_u, part.begin_v),
                               at(part.end_u, part.end_v), at(part.begin_u, part.end_v)};
  Vector3 normal = (face[2] - face[0]).cross(face[3] - face[1]).normalized();
  if (normal.dot(outwards) < 0.0) normal = -normal;
  std::array<VehicleSection, 2> sides;
  for (const Vector3& corner : face) {
    sides[0].push_back(corner - kDepth_m * normal);
    sides[1].push_back(corner + proud_m * normal);
  }
  return MakeLoft(sides);
}

std::array<Vector3, 4> FaceBetween(const VehicleSection& a,
                                   const VehicleSection& b,
                                   std::size_t index) {
  const std::size_t next = (index + 1) % a.size();
  return {a[index], a[next], b[next], b[index]};
}

}  // namespace railcast
