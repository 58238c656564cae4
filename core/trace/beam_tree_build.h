#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <type_traits>
#include <vector>

#include "core/trace/beam_tree.h"
#include "core/trace/embree.h"

namespace railcast {

/// A tree of beam_tree.h with its memory.
class BeamTree {
 public:
  BeamTree() = default;
  [[nodiscard]] TreePointer root() const { return root_; }
  [[nodiscard]] const Eigen::AlignedBox3f& bounds() const { return bounds_; }

 private:
  struct Release {
    void operator()(RTCBVH bvh) const { rtcReleaseBVH(bvh); }
  };
  friend class BeamTreeBuilder;
  std::unique_ptr<std::remove_pointer_t<RTCBVH>, Release> memory_;
  TreePointer root_{};
  Eigen::AlignedBox3f bounds_;
};

/// A triangle of a model.
struct BeamTriangle {
  Eigen::Vector3f corners[3];
  std::uint32_t part{};
};

// Both builders must be called within BuildWithEmbree(), which reports their errors.

/// Builds a model's tree, with leaves of up to kLeafWidth triangles.
[[nodiscard]] BeamTree BuildModelTree(RTCDevice device, const std::vector<BeamTriangle>& triangles);

/// Builds a scene's tree, whose leaves are the indices of the boxes. Empty boxes are left out.
[[nodiscard]] BeamTree BuildSceneTree(RTCDevice device,
                                      const std::vector<Eigen::AlignedBox3f>& boxes);

}  // namespace railcast
