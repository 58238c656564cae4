#pragma once

#include <filesystem>

#include "core/mesh/mesh_import.h"

namespace railcast {

/// All parts of a mesh in one.
inline Mesh Merged(const ImportedMesh& imported) {
  Mesh mesh;
  for (const NamedMesh& part : imported.parts) mesh.Append(part.mesh);
  return mesh;
}

inline Mesh ReadMerged(const std::filesystem::path& file, double unit_m, bool y_up) {
  return Merged(ReadMesh(file, {.unit_m = unit_m, .y_up = y_up}));
}

inline Eigen::AlignedBox3d Bounds(const Mesh& mesh) {
  return Model{.name = "", .parts = {{.mesh = mesh, .material = 0, .label = 0}}}.Bounds();
}

inline double Area(const Mesh& mesh) {
  double sum = 0.0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Eigen::Vector3f ab = mesh.vertices[b] - mesh.vertices[a];
    const Eigen::Vector3f ac = mesh.vertices[c] - mesh.vertices[a];
    sum += 0.5 * static_cast<double>(ab.cross(ac).norm());
  }
  return sum;
}

}  // namespace railcast
