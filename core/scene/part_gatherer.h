#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "railcast/scene.h"

namespace railcast {

struct MeshSize {
  std::size_t num_vertices{};
  std::size_t num_triangles{};
};

/// Merges models into one frame, with as few parts as labels and materials allow. Drawing or
/// writing a piece of the world then handles a few dozen meshes instead of thousands of models.
class PartGatherer {
 public:
  /// @param gathered_from_model May include a scale.
  void Add(const Model& model, const Eigen::Affine3d& gathered_from_model);

  /// What was added since the last call of TakeParts().
  [[nodiscard]] MeshSize size() const;

  /// Returns all triangles added since the last call: one part for each pair of label and material,
  /// in that order, none without triangles. Wires are included, but their parts are not marked as
  /// `is_wire`.
  [[nodiscard]] std::vector<Part> TakeParts();

 private:
  using Key = std::pair<std::uint32_t, std::uint16_t>;  ///< Label, material.
  std::map<Key, Mesh> meshes_;
};

}  // namespace railcast
