#include "core/rail/ground/outer_ground.h"

#include <cstdint>

#include "core/base/error.h"

namespace railcast {

Mesh MeshBetween(const GroundLine& right, const GroundLine& left) {
  const std::size_t num_right = right.points_m.size();
  const std::size_t num_left = left.points_m.size();
  Check(num_right >= 2 && num_left >= 2, "a line of the ground has two ends");
  Mesh mesh;
  for (const GroundLine& line : {right, left}) {
    for (const Vector3& point_m : line.points_m) mesh.vertices.emplace_back(point_m.cast<float>());
  }
  std::size_t i = 0;
  std::size_t j = 0;
  while (i + 1 < num_right || j + 1 < num_left) {
    const auto right_vertex = static_cast<std::uint32_t>(i);
    const auto left_vertex = static_cast<std::uint32_t>(num_right + j);
    const bool is_right_next =
        j + 1 == num_left ||
        (i + 1 < num_right && right.stations_m[i + 1] <= left.stations_m[j + 1]);
    if (is_right_next) {
      mesh.triangles.push_back({right_vertex, right_vertex + 1, left_vertex});
      ++i;
    } else {
      mesh.triangles.push_back({right_vertex, left_vertex + 1, left_vertex});
      ++j;
    }
  }
  return mesh;
}

}  // namespace railcast
