#include <cstdint>
#include <sstream>
#include <string>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/mesh/mesh_format.h"
#include "core/mesh/mesh_import.h"
#include "tests/fuzz/fuzz_target.h"

namespace railcast {
namespace {

void CheckMesh(const Mesh& mesh) {
  Check(!mesh.triangles.empty(), "a mesh has a triangle");
  for (const Eigen::Vector3f& vertex : mesh.vertices) {
    Check(vertex.allFinite(), "a vertex is somewhere");
  }
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t corner : triangle) {
      Check(corner < mesh.vertices.size(), "a corner is a vertex");
    }
  }
}

std::string ObjText(const Mesh& mesh) {
  std::string text;
  for (const Eigen::Vector3f& vertex : mesh.vertices) {
    text += "v " + NumberText(vertex.x()) + ' ' + NumberText(vertex.y()) + ' ' +
            NumberText(vertex.z()) + '\n';
  }
  for (const auto& [a, b, c] : mesh.triangles) {
    text += "f " + NumberText(a + 1) + ' ' + NumberText(b + 1) + ' ' + NumberText(c + 1) + '\n';
  }
  return text;
}

void ReadBytes(const std::string& bytes, const MeshUnits& units) {
  const auto format = MeshFormatOf(bytes, "fuzz");
  if (format && IsScene(*format)) return;  // That is for assimp.
  try {
    const ImportedMesh imported = ParseMesh(bytes, "fuzz", units);
    Mesh mesh;
    for (const NamedMesh& part : imported.parts) {
      CheckMesh(part.mesh);
      mesh.Append(part.mesh);
    }
    // Centring moves it by a rounding, after which other slivers may have no area.
    const ImportedMesh again = ParseMesh(ObjText(mesh), "fuzz.obj");
    Check(again.num_faces == mesh.triangles.size(), "what is written is read");
  } catch (const InputError& error) {
    std::istringstream lines(error.what());
    for (std::string line; std::getline(lines, line);) {
      Check(line.starts_with("fuzz: ") || line == "fuzz.obj: holds no triangle",
            "a fault names its file");
    }
  }
}

}  // namespace
}  // namespace railcast

/// Entry point for libFuzzer. The first byte selects unit and up axis of the file: m or c for
/// metres or centimetres with z up, M or C with y up, anything else for kilometres with z up.
RAILCAST_FUZZ_TARGET(mesh) {
  if (size == 0) return 0;
  const char kind = static_cast<char>(data[0]);
  const bool y_up = kind == 'M' || kind == 'C';
  const double unit_m = kind == 'm' || kind == 'M' ? 1.0 : kind == 'c' || kind == 'C' ? 0.01 : 1e3;
  railcast::ReadBytes(std::string(reinterpret_cast<const char*>(data) + 1, size - 1),
                      {.unit_m = unit_m, .y_up = y_up});
  return 0;
}
