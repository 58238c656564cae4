#pragma once

#include <memory>
#include <mutex>
#include <new>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include <tbb/task_arena.h>

#include "core/base/error.h"
#include "core/base/out_of_memory.h"
#include "core/trace/beam_tree_build.h"
#include "core/trace/embree.h"
#include "core/trace/trace_scene.h"

namespace railcast {

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
  bool is_wire{};
};

/// A model's trees for beams. Wires are apart, because most beams leave them out (effect
/// thin_conductors).
struct BeamTrees {
  BeamTree solid;
  BeamTree wires;
};

/// Embree's scene of a model, and its trees for beams.
struct TraceModel::Handle {
  std::shared_ptr<TraceDevice::Handle> device;
  RTCScene scene{};
  std::string name;
  bool is_foliage{};
  std::vector<PartSize> parts;
  struct Sphere {
    Eigen::Vector3f center_m = Eigen::Vector3f::Zero();
    float radius_m{};
  };
  Sphere sphere;  ///< Contains the model.

  ~Handle() {
    if (scene != nullptr) rtcReleaseScene(scene);
  }

  /// The trees for beams. They are built when they are first needed, with triangles read back from
  /// Embree.
  [[nodiscard]] const BeamTrees& beam_trees() const;
  /// For WithinMemory: "building "wagon" for ray tracing (3120 triangles)".
  [[nodiscard]] std::string Doing() const;

 private:
  mutable std::once_flag beam_trees_once_;
  mutable BeamTrees beam_trees_;
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

/// Of closed surfaces: no ray passes between two triangles that share an edge.
inline constexpr RTCSceneFlags kWatertight = RTC_SCENE_FLAG_ROBUST;
/// Of foliage, which is no closed surface; faster.
inline constexpr RTCSceneFlags kOpen = RTC_SCENE_FLAG_NONE;

/// Of the settings measured, a higher quality gains nothing (docs/performance.md).
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

}  // namespace railcast
