#include "core/trace/trace_handles.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <new>

namespace railcast {
namespace {

TreePointer PointerTo(const void* child) {
  return std::bit_cast<TreePointer>(child);
}

void* AsVoid(TreePointer pointer) {
  return std::bit_cast<void*>(pointer);
}

BeamNode& NodeAt(void* pointer) {
  return *std::bit_cast<BeamNode*>(PointerTo(pointer) & kAddressBits);
}

template <typename Item>
Item* Allocate(RTCThreadLocalAllocator allocator) {
  return static_cast<Item*>(rtcThreadLocalAlloc(allocator, sizeof(Item), alignof(Item)));
}

// Embree's builder calls the functions below, whose signatures it prescribes. What they return as a
// pointer is a TreePointer.

void* MakeNode(RTCThreadLocalAllocator allocator, unsigned num_children, void* /*user*/) {
  auto* const node = Allocate<BeamNode>(allocator);
  *node = BeamNode{};
  return AsVoid(PointerTo(node) | TreePointer{num_children - 1} << kNumShift);
}

void SetChildren(void* at, void** children, unsigned num_children, void* /*user*/) {
  BeamNode& node = NodeAt(at);
  for (unsigned k = 0; k < num_children; ++k) node.child[k] = PointerTo(children[k]);
}

void SetBounds(void* at, const RTCBounds** bounds, unsigned num_children, void* /*user*/) {
  BeamNode& node = NodeAt(at);
  for (unsigned k = 0; k < num_children; ++k) {
    const RTCBounds& box = *bounds[k];
    const float lower[3] = {box.lower_x, box.lower_y, box.lower_z};
    const float upper[3] = {box.upper_x, box.upper_y, box.upper_z};
    for (int i = 0; i < 3; ++i) {
      node.lower[i][k] = lower[i];
      node.upper[i][k] = upper[i];
    }
  }
}

void* MakeTriangleLeaf(RTCThreadLocalAllocator allocator,
                       const RTCBuildPrimitive* primitives,
                       std::size_t num,
                       void* user) {
  const auto& triangles = *static_cast<const std::vector<BeamTriangle>*>(user);
  auto* const leaf = Allocate<BeamLeaf>(allocator);
  *leaf = BeamLeaf{};
  for (std::size_t k = 0; k < kLeafWidth; ++k) {
    const BeamTriangle& triangle = triangles[primitives[std::min(k, num - 1)].primID];
    for (int corner = 0; corner < 3; ++corner) {
      for (int i = 0; i < 3; ++i) leaf->corner[corner][i][k] = triangle.corners[corner][i];
    }
    leaf->part[k] = triangle.part;
  }
  return AsVoid(PointerTo(leaf) | TreePointer{num - 1} << kNumShift | kIsLeafBit);
}

void* MakeInstanceLeaf(RTCThreadLocalAllocator /*allocator*/,
                       const RTCBuildPrimitive* primitives,
                       std::size_t /*num*/,
                       void* /*user*/) {
  return AsVoid(TreePointer{primitives[0].primID} << kNumShift | kIsLeafBit);
}

RTCBuildPrimitive PrimitiveOf(const Eigen::AlignedBox3f& box, std::size_t index) {
  return {.lower_x = box.min().x(),
          .lower_y = box.min().y(),
          .lower_z = box.min().z(),
          .geomID = 0,
          .upper_x = box.max().x(),
          .upper_y = box.max().y(),
          .upper_z = box.max().z(),
          .primID = static_cast<unsigned>(index)};
}

}  // namespace

class BeamTreeBuilder {
 public:
  BeamTreeBuilder(RTCDevice device, std::vector<RTCBuildPrimitive> primitives)
      : device_(device), primitives_(std::move(primitives)) {}

  /// Builds with leaves of up to `max_leaf_size` primitives.
  BeamTree Build(RTCCreateLeafFunction make_leaf, const void* user, unsigned max_leaf_size) {
    BeamTree tree;
    if (primitives_.empty()) return tree;
    for (const RTCBuildPrimitive& box : primitives_) {
      tree.bounds_.extend(Eigen::Vector3f(box.lower_x, box.lower_y, box.lower_z));
      tree.bounds_.extend(Eigen::Vector3f(box.upper_x, box.upper_y, box.upper_z));
    }
    tree.memory_.reset(rtcNewBVH(device_));
    if (tree.memory_ == nullptr) throw std::bad_alloc();
    RTCBuildArguments arguments = rtcDefaultBuildArguments();
    arguments.byteSize = sizeof arguments;
    arguments.buildQuality = RTC_BUILD_QUALITY_MEDIUM;
    arguments.maxBranchingFactor = kTreeWidth;
    arguments.maxDepth = kTreeDepth;
    // A leaf's triangles are tested together, at the cost of a node; leaves of fewer than fit take
    // a third more time.
    arguments.sahBlockSize = max_leaf_size;
    arguments.intersectionCost = 1.0F;
    arguments.minLeafSize = max_leaf_size;
    arguments.maxLeafSize = max_leaf_size;
    arguments.bvh = tree.memory_.get();
    arguments.primitives = primitives_.data();
    arguments.primitiveCount = primitives_.size();
    arguments.primitiveArrayCapacity = primitives_.size();
    arguments.createNode = MakeNode;
    arguments.setNodeChildren = SetChildren;
    arguments.setNodeBounds = SetBounds;
    arguments.createLeaf = make_leaf;
    arguments.userPtr = const_cast<void*>(user);
    tree.root_ = PointerTo(rtcBuildBVH(&arguments));
    return tree;
  }

 private:
  RTCDevice device_;
  std::vector<RTCBuildPrimitive> primitives_;
};

BeamTree BuildModelTree(RTCDevice device, const std::vector<BeamTriangle>& triangles) {
  std::vector<RTCBuildPrimitive> primitives;
  primitives.reserve(triangles.size());
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    Eigen::AlignedBox3f box;
    for (const Eigen::Vector3f& corner : triangles[i].corners) box.extend(corner);
    primitives.push_back(PrimitiveOf(box, i));
  }
  return BeamTreeBuilder(device, std::move(primitives))
      .Build(MakeTriangleLeaf, &triangles, kLeafWidth);
}

BeamTree BuildSceneTree(RTCDevice device, const std::vector<Eigen::AlignedBox3f>& boxes) {
  std::vector<RTCBuildPrimitive> primitives;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (!boxes[i].isEmpty()) primitives.push_back(PrimitiveOf(boxes[i], i));
  }
  return BeamTreeBuilder(device, std::move(primitives)).Build(MakeInstanceLeaf, nullptr, 1);
}

}  // namespace railcast
