#include "core/scene/part_gatherer.h"

namespace railcast {

void PartGatherer::Add(const Model& model, const Eigen::Affine3d& gathered_from_model) {
  for (const Part& part : model.parts) {
    if (part.mesh.triangles.empty()) continue;
    Mesh& mesh = meshes_[{part.label, part.material}];
    const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const Eigen::Vector3f& vertex : part.mesh.vertices) {
      mesh.vertices.emplace_back((gathered_from_model * vertex.cast<double>()).cast<float>());
    }
    for (const auto& [a, b, c] : part.mesh.triangles) {
      mesh.triangles.push_back({a + base, b + base, c + base});
    }
  }
}

MeshSize PartGatherer::size() const {
  MeshSize size;
  for (const auto& [key, mesh] : meshes_) {
    size.num_vertices += mesh.vertices.size();
    size.num_triangles += mesh.triangles.size();
  }
  return size;
}

std::vector<Part> PartGatherer::TakeParts() {
  std::vector<Part> parts;
  for (auto& [key, mesh] : meshes_) parts.push_back({std::move(mesh), key.second, key.first});
  meshes_.clear();
  return parts;
}

}  // namespace railcast
