#include "railcast/scene.h"

namespace railcast {

void Mesh::Append(const Mesh& other, const Transform& this_from_other) {
  const auto base = static_cast<std::uint32_t>(vertices.size());
  vertices.reserve(vertices.size() + other.vertices.size());
  for (const Eigen::Vector3f& vertex : other.vertices) {
    vertices.emplace_back((this_from_other * vertex.cast<double>()).cast<float>());
  }
  triangles.reserve(triangles.size() + other.triangles.size());
  for (const auto& [a, b, c] : other.triangles) {
    triangles.push_back({a + base, b + base, c + base});
  }
}

std::size_t Model::num_triangles() const {
  std::size_t count = 0;
  for (const Part& part : parts) count += part.mesh.triangles.size();
  return count;
}

Eigen::AlignedBox3d Model::Bounds() const {
  Eigen::AlignedBox3d box;
  for (const Part& part : parts) {
    for (const Eigen::Vector3f& vertex : part.mesh.vertices) box.extend(vertex.cast<double>());
  }
  return box;
}

}  // namespace railcast
