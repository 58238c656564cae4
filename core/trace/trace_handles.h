#pragma once

#include <embree3/rtcore.h>

#include <memory>
#include <mutex>
#include <new>
#include <string>
#include <type_traits>
#include <vector>

#include "core/base/error.h"
#include "core/trace/beam_tree_build.h"
#include "core/trace/embree_error.h"
#include "core/trace/trace_scene.h"

namespace railcast {

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
