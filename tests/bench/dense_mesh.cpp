#include "tests/bench/dense_mesh.h"

#include <array>
#include <cstdint>
#include <map>
#include <random>
#include <tuple>
#include <utility>
#include <vector>

namespace railcast {
namespace {

/// The mesh with one vertex for each place.
Mesh Welded(const Mesh& mesh) {
  Mesh welded;
  std::map<std::tuple<float, float, float>, std::uint32_t> number_of;
  for (std::array<std::uint32_t, 3> triangle : mesh.triangles) {
    for (std::uint32_t& corner : triangle) {
      const Eigen::Vector3f& point = mesh.vertices[corner];
      const auto [it, is_new] = number_of.try_emplace(
          {point.x(), point.y(), point.z()}, static_cast<std::uint32_t>(welded.vertices.size()));
      if (is_new) welded.vertices.push_back(point);
      corner = it->second;
    }
    welded.triangles.push_back(triangle);
  }
  return welded;
}

Mesh SubdividedOnce(const Mesh& mesh) {
  Mesh finer{.vertices = mesh.vertices, .triangles = {}};
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middle_of;
  const auto middle = [&](std::uint32_t a, std::uint32_t b) {
    const auto [it, is_new] =
        middle_of.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(finer.vertices.size()));
    if (is_new) finer.vertices.emplace_back(0.5F * (mesh.vertices[a] + mesh.vertices[b]));
    return it->second;
  };
  for (const auto& [a, b, c] : mesh.triangles) {
    const std::uint32_t ab = middle(a, b);
    const std::uint32_t bc = middle(b, c);
    const std::uint32_t ca = middle(c, a);
    finer.triangles.insert(finer.triangles.end(),
                           {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
  }
  return finer;
}

}  // namespace

Mesh Subdivided(const Mesh& mesh, int num_times) {
  Mesh finer = Welded(mesh);
  for (int i = 0; i < num_times; ++i) finer = SubdividedOnce(finer);
  return finer;
}

void AddNoise(double sigma_m, Mesh& mesh) {
  std::vector<Eigen::Vector3f> normals(mesh.vertices.size(), Eigen::Vector3f::Zero());
  for (const auto& [a, b, c] : mesh.triangles) {
    const Eigen::Vector3f normal =
        (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]);
    for (const std::uint32_t corner : {a, b, c}) normals[corner] += normal;
  }
  std::mt19937 generator(1);
  std::normal_distribution<float> noise_m(0.0F, static_cast<float>(sigma_m));
  for (std::size_t v = 0; v < normals.size(); ++v) {
    mesh.vertices[v] += noise_m(generator) * normals[v].stableNormalized();
  }
}

}  // namespace railcast
