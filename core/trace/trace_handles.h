#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <new>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include <tbb/task_arena.h>

#include "core/base/error.h"
#include "core/base/out_of_memory.h"
#include "core/trace/beam_tree.h"
#include "core/trace/embree.h"
#include "core/trace/trace_scene.h"

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

/// Throws if the calling thread's last use of Embree failed. Embree does not throw but records the
/// first error of each thread. If it were not queried, a scene that did not fit into memory would
/// let all rays pass through.
/// @param device Null: asks why no device could be made.
/// @param doing Words after "while", as for WithinMemory().
/// @throws InputError if memory ran out.
inline void ThrowIfEmbreeFailed(RTCDevice device, const std::string& doing) {
  const RTCError error = rtcGetDeviceError(device);
  if (error == RTC_ERROR_NONE) return;
  if (error == RTC_ERROR_OUT_OF_MEMORY) throw OutOfMemory(doing);
  throw std::runtime_error("Embree's error " + std::to_string(error) + " while " + doing);
}

/// Runs `build`, which uses Embree, with a single thread: the order of primitives in the leaves
/// decides what a ray on an edge hits, and that order must not depend on how the work was shared.
/// @param doing As for WithinMemory().
/// @throws InputError if memory runs out.
template <typename Doing, typename Build>
void BuildWithEmbree(RTCDevice device, const Doing& doing, const Build& build) {
  // Clear an error left by an earlier failed build.
  static_cast<void>(rtcGetDeviceError(device));
  WithinMemory(doing, [&] {
    tbb::task_arena one_thread(1);
    one_thread.execute(build);
  });
  ThrowIfEmbreeFailed(device, doing());
}

struct TraceDevice::Handle {
  explicit Handle(const std::string& config) : device(rtcNewDevice(config.c_str())) {
    const std::string doing = "making a device for ray tracing";
    if (device == nullptr) ThrowIfEmbreeFailed(nullptr, doing);
    Check(device != nullptr, "Embree says why it makes no device");
    ThrowIfEmbreeFailed(device, doing);
  }
  ~Handle() { rtcReleaseDevice(device); }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;

  RTCDevice device;
};

/// What is needed to read a part's triangles back from Embree.
struct PartSize {
  std::size_t num_triangles{};
  std::uint32_t label{};
  bool is_wire{};
};

/// A model's trees for beams. Wires are apart, because most beams leave them out (effect
/// thin_conductors).
struct BeamTrees {
  BeamTree solid;
  BeamTree wires;
};

/// The labels of the surfaces that trees are made of; nothing = all surfaces.
using LabelsOfBeams = std::optional<std::vector<std::uint32_t>>;

/// Embree's scene of a model, and its trees for beams.
struct TraceModel::Handle {
  std::shared_ptr<TraceDevice::Handle> device;
  RTCScene scene{};
  std::string name;
  bool is_foliage{};
  std::vector<PartSize> parts;
  Eigen::AlignedBox3f box_m;  ///< Contains the model; a point if that has nothing.

  ~Handle() {
    if (scene != nullptr) rtcReleaseScene(scene);
  }

  /// The trees for beams. They are built when they are first needed, with triangles read back from
  /// Embree.
  [[nodiscard]] const BeamTrees& beam_trees(const LabelsOfBeams& labels) const;
  /// For WithinMemory: "building "wagon" for ray tracing (3120 triangles)".
  [[nodiscard]] std::string Doing() const;

 private:
  mutable std::mutex beam_trees_mutex_;
  mutable std::map<LabelsOfBeams, BeamTrees> beam_trees_;
};

struct ReleaseGeometry {
  void operator()(RTCGeometry geometry) const { rtcReleaseGeometry(geometry); }
};
using OwnedGeometry = std::unique_ptr<std::remove_pointer_t<RTCGeometry>, ReleaseGeometry>;

/// Embree returns null where C++ throws std::bad_alloc; convert it.
inline OwnedGeometry NewGeometry(RTCDevice device, RTCGeometryType type) {
  OwnedGeometry geometry(rtcNewGeometry(device, type));
  if (geometry == nullptr) throw std::bad_alloc();
  rtcSetGeometryMask(geometry.get(), ~0U);  // Embree 4 begins with 1.
  return geometry;
}

/// For closed surfaces: no ray passes between two triangles that share an edge.
inline constexpr RTCSceneFlags kWatertight = RTC_SCENE_FLAG_ROBUST;
/// For foliage, which is no closed surface; faster.
inline constexpr RTCSceneFlags kOpen = RTC_SCENE_FLAG_NONE;

/// A higher quality than this gained nothing when measured (docs/results/performance.md).
inline RTCScene NewScene(RTCDevice device, RTCSceneFlags flags) {
  RTCScene scene = rtcNewScene(device);
  if (scene == nullptr) throw std::bad_alloc();
  rtcSetSceneFlags(scene, flags);
  rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_MEDIUM);
  return scene;
}

/// Makes a new scene with the geometry that `attach` adds.
/// @throws InputError if memory runs out.
template <typename Doing, typename Attach>
void BuildScene(RTCDevice device,
                RTCSceneFlags flags,
                RTCScene& scene,
                const Doing& doing,
                const Attach& attach) {
  BuildWithEmbree(device, doing, [&] {
    scene = NewScene(device, flags);
    attach();
    rtcCommitScene(scene);
  });
}

/// A box, against which a ray is tested in four lanes. The last one is endless.
struct SlabBox {
  SlabBox() = default;
  explicit SlabBox(const Eigen::AlignedBox3f& box_m) {
    min_m.head<3>() = box_m.min().array();
    max_m.head<3>() = box_m.max().array();
  }
  [[nodiscard]] SlabBox Merged(const SlabBox& other) const {
    SlabBox both;
    both.min_m = min_m.min(other.min_m);
    both.max_m = max_m.max(other.max_m);
    return both;
  }

  /// Empty at first.
  Eigen::Array4f min_m{kEndless, kEndless, kEndless, -kEndless};
  Eigen::Array4f max_m{-kEndless, -kEndless, -kEndless, kEndless};

 private:
  static constexpr float kEndless = std::numeric_limits<float>::infinity();
};

/// The figures of a scene as one geometry of Embree. Each pose is made when a ray first needs it.
class PosedFigures {
 public:
  /// A piece of a figure in one of its poses.
  struct PlacedPiece {
    Eigen::Matrix<float, 3, 4> window_from_piece;
    SlabBox window_box_m;  ///< Contains it.
  };
  /// All pieces of a figure at a step.
  struct Pose {
    std::once_flag once;
    std::vector<PlacedPiece> pieces;
    SlabBox window_box_m;  ///< Contains them.
  };

  explicit PosedFigures(TraceFigures figures);
  PosedFigures(const PosedFigures&) = delete;
  PosedFigures& operator=(const PosedFigures&) = delete;

  [[nodiscard]] const std::vector<TraceFigure>& figures() const { return figures_.figures; }
  /// The pose of a figure at a step. Thread-safe.
  [[nodiscard]] const Pose& PoseAt(std::size_t figure, std::uint32_t step) const;

  /// Attaches the figures to a scene of Embree as its geometry 0. They must outlive it.
  ///
  /// A hit names the figure as its instance. Its geometry is the surface, counted from the figure's
  /// first one, and its normal stands in the window's axes.
  void AttachTo(RTCDevice device, RTCScene scene) const;

 private:
  struct Probe;

  static void ReportBox(const RTCBoundsFunctionArguments* args);
  static void IntersectRays(const RTCIntersectFunctionNArguments* args);
  /// Returns whether the ray hits a piece nearer than before, and puts the hit into it.
  bool Intersect(std::size_t figure,
                 const Probe& probe,
                 RayQueryContext& context,
                 RTCRayHit& ray) const;

  TraceFigures figures_;
  std::vector<std::size_t> first_poses_;  ///< By figure, index into `poses_`.
  mutable std::vector<Pose> poses_;
};

}  // namespace railcast
