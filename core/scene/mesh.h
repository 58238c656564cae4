#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/base/transform.h"

namespace railcast {

/// An indexed triangle soup: nothing need be manifold, closed or consistently wound.
struct Mesh {
  std::vector<Eigen::Vector3f> vertices;                ///< m, in the frame of the owning model.
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< Indices into `vertices`.

  /// Appends another soup, moved by `this_from_other`.
  void Append(const Mesh& other, const Transform& this_from_other = Transform::Identity());
};

/// Triangles that share a material and a label.
struct Part {
  Mesh mesh;
  std::uint16_t material{};  ///< Index into the material library.
  std::uint32_t label{};     ///< Id in the label table.
  bool is_wire = false;      ///< Tubes that Chunk::wires describes as polylines.
};

/// Geometry that may stand in many places.
struct Model {
  std::string name;
  std::vector<Part> parts;

  [[nodiscard]] std::size_t num_triangles() const;
  /// The axis-aligned box in the model's own frame; empty if there is no vertex.
  [[nodiscard]] Eigen::AlignedBox3d Bounds() const;
};

/// A model at a place. The rotation may carry a uniform scale.
struct Placement {
  std::shared_ptr<const Model> model;
  Eigen::Affine3d chunk_from_model = Eigen::Affine3d::Identity();
  std::uint32_t instance{};  ///< 0 = stuff.
};

}  // namespace railcast
