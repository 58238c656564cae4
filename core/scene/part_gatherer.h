#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "core/scene/mesh.h"

namespace railcast {

/// Puts models into one frame, in as few parts as labels and materials allow: what draws or writes
/// a piece of a world takes thousands of models as some dozens of meshes.
class PartGatherer {
 public:
  /// @param gathered_from_model May carry a scale.
  void Add(const Model& model, const Eigen::Affine3d& gathered_from_model);

  /// All triangles added since it was last called, each once: a part for each pair of label and
  /// material, ordered by them. Wires are among them, their parts not marked as such.
  [[nodiscard]] std::vector<Part> TakeParts();

 private:
  using Key = std::pair<std::uint32_t, std::uint16_t>;  ///< Label, material.
  std::map<Key, Mesh> meshes_;
};

}  // namespace railcast
