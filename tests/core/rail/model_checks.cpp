#include "tests/core/rail/model_checks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <utility>

namespace railcast {
namespace {

const Mesh* FindMesh(const Model& model, const SurfaceClass& surface) {
  for (const Part& part : model.parts) {
    if (part.material == surface.material && part.label == surface.label) return &part.mesh;
  }
  return nullptr;
}

void ExpectSameModel(const Model& first, const Model& second) {
  ASSERT_EQ(first.parts.size(), second.parts.size()) << first.name;
  for (std::size_t i = 0; i < first.parts.size(); ++i) {
    EXPECT_EQ(first.parts[i].mesh.vertices, second.parts[i].mesh.vertices) << first.name;
    EXPECT_EQ(first.parts[i].mesh.triangles, second.parts[i].mesh.triangles) << first.name;
  }
}

}  // namespace

std::vector<Vector3> VerticesOf(const Model& model, const SurfaceClass& surface) {
  std::vector<Vector3> vertices;
  if (const Mesh* mesh = FindMesh(model, surface)) {
    for (const Eigen::Vector3f& vertex : mesh->vertices) vertices.push_back(vertex.cast<double>());
  }
  return vertices;
}

std::vector<double> LongestEdges_m(const Model& model, const SurfaceClass& surface) {
  std::vector<double> lengths_m;
  if (const Mesh* mesh = FindMesh(model, surface)) {
    for (const auto& [a, b, c] : mesh->triangles) {
      const Eigen::Vector3f& pa = mesh->vertices[a];
      const Eigen::Vector3f& pb = mesh->vertices[b];
      const Eigen::Vector3f& pc = mesh->vertices[c];
      lengths_m.push_back(
          static_cast<double>(std::max({(pb - pa).norm(), (pc - pb).norm(), (pa - pc).norm()})));
    }
  }
  return lengths_m;
}

std::size_t CountBadTriangles(const Model& model) {
  std::size_t count = 0;
  for (const Part& part : model.parts) {
    const auto& vertices = part.mesh.vertices;
    for (const auto& [a, b, c] : part.mesh.triangles) {
      if (std::max({a, b, c}) >= vertices.size()) {
        ++count;
        continue;
      }
      const Vector3 ab = (vertices[b] - vertices[a]).cast<double>();
      const Vector3 ac = (vertices[c] - vertices[a]).cast<double>();
      if (!(ab.cross(ac).norm() > 0.0) || !vertices[a].allFinite()) ++count;
    }
  }
  return count;
}

std::size_t CountOpenEdges(const Model& model) {
  using Point = std::array<float, 3>;
  std::map<std::pair<Point, Point>, int> surplus;
  for (const Part& part : model.parts) {
    for (const auto& triangle : part.mesh.triangles) {
      for (std::size_t i = 0; i < 3; ++i) {
        const Eigen::Vector3f& a = part.mesh.vertices[triangle[i]];
        const Eigen::Vector3f& b = part.mesh.vertices[triangle[(i + 1) % 3]];
        const Point from = {a.x(), a.y(), a.z()};
        const Point to = {b.x(), b.y(), b.z()};
        if (from < to) ++surplus[{from, to}];
        if (to < from) --surplus[{to, from}];
      }
    }
  }
  return static_cast<std::size_t>(std::count_if(surplus.begin(), surplus.end(),
                                                [](const auto& edge) { return edge.second != 0; }));
}

std::size_t CountOpenEdges(const Mesh& mesh) {
  return CountOpenEdges(Model{.name = "", .parts = {{.mesh = mesh, .material = 0, .label = 0}}});
}

void ExpectSameChunk(const Chunk& first, const Chunk& second) {
  ExpectSameModel(first.ground, second.ground);
  ASSERT_EQ(first.placements.size(), second.placements.size());
  for (std::size_t i = 0; i < first.placements.size(); ++i) {
    EXPECT_EQ(first.placements[i].chunk_from_model.matrix(),
              second.placements[i].chunk_from_model.matrix());
    EXPECT_EQ(first.placements[i].instance, second.placements[i].instance);
    ExpectSameModel(*first.placements[i].model, *second.placements[i].model);
  }
}

}  // namespace railcast
