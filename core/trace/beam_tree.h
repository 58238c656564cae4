#pragma once

#include <cstddef>
#include <cstdint>

namespace railcast {

// The trees in which beams are traced (trace_beam.h), as plain data, since the code that traverses
// them is compiled once per instruction set.

/// Number of children of a node.
inline constexpr std::size_t kTreeWidth = 16;
/// Number of triangles of a leaf.
inline constexpr std::size_t kLeafWidth = 8;

/// Bound of a tree's depth, from which follows how many entries a traversal's stack needs.
inline constexpr std::size_t kTreeDepth = 48;

/// Points to a child: a node, or, if the lowest bit is set, a leaf. 0 = an empty tree. Leaves of a
/// model's tree are BeamLeaf; a leaf of a scene's tree is an instance, whose index stands in the
/// other bits. The address of a node or BeamLeaf leaves the lowest bits free: those above the first
/// hold its number of children or triangles less one, for which nodes and leaves have no room left
/// in their cache lines.
using TreePointer = std::uintptr_t;
inline constexpr TreePointer kIsLeafBit = 1;
inline constexpr unsigned kNumShift = 1;
inline constexpr TreePointer kAddressBits = ~TreePointer{0x3F};

/// An inner node: the bounding boxes of its children, by axis.
struct alignas(64) BeamNode {
  float lower[3][kTreeWidth], upper[3][kTreeWidth];
  TreePointer child[kTreeWidth];
};
static_assert((kTreeWidth - 1) << kNumShift < alignof(BeamNode));

/// Up to kLeafWidth triangles of a model. Unused lanes repeat the last triangle.
struct alignas(64) BeamLeaf {
  float corner[3][3][kLeafWidth];  ///< [corner][axis]
  std::uint32_t part[kLeafWidth];  ///< Part of the model that the triangle belongs to.
};

/// An affine transform: the first three rows of the matrix, row by row.
struct Rows {
  float m[12];
};

/// A box along the axes of its frame.
struct BeamBox {
  float lower[3], upper[3];
};

/// A placed model.
struct BeamInstance {
  TreePointer root{};             ///< The model's tree.
  std::uint32_t first_surface{};  ///< Surface of the model's part 0.
  std::uint32_t num_steps{};
  bool is_stretched{};  ///< Whether it is scaled by more in one direction than in another.
  const Rows* window_from_model{};  ///< At `num_steps` equal steps of the shutter; 1 = stationary.
  Rows model_from_window{};         ///< If stationary.
  const BeamBox* window_boxes{};    ///< About the model at these steps; null if stationary.
};

/// A scene: a tree of instances.
struct BeamScene {
  TreePointer root{};
  const BeamInstance* instances{};
};

/// The same for what is no wire, and for wires.
struct BeamScenes {
  BeamScene solid;
  BeamScene wires;
};

}  // namespace railcast
