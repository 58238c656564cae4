#include "core/trace/trace_scene.h"

#include <embree3/rtcore.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <new>
#include <stdexcept>
#include <type_traits>

#include "core/base/error.h"
#include "core/base/out_of_memory.h"
#include "core/base/text.h"
#include "core/trace/trace_program.h"
#include "railcast/lidar.h"

namespace railcast {

static_assert(kTileSize % kPacketSize == 0);

namespace {

// Embree does not throw but records the first error of each thread. If it were not queried, a scene
// that did not fit into memory would let all rays pass through.
// @param device Null: asks why no device could be made.
template <typename Doing>
void ThrowIfFailed(RTCDevice device, const Doing& doing) {
  const RTCError error = rtcGetDeviceError(device);
  if (error == RTC_ERROR_NONE) return;
  if (error == RTC_ERROR_OUT_OF_MEMORY) throw OutOfMemory(doing());
  throw std::runtime_error("Embree's error " + std::to_string(error) + " while " + doing());
}

}  // namespace

struct TraceDevice::Handle {
  explicit Handle(const std::string& config) : device(rtcNewDevice(config.c_str())) {
    const auto doing = [] { return std::string("making a device for ray tracing"); };
    if (device == nullptr) ThrowIfFailed(nullptr, doing);
    Check(device != nullptr, "Embree says why it makes no device");
    ThrowIfFailed(device, doing);
  }
  ~Handle() { rtcReleaseDevice(device); }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;

  RTCDevice device;
};

TraceDevice::TraceDevice(const std::string& isa)
    : handle_(std::make_shared<Handle>(isa.empty() ? "" : "isa=" + IsaInUse(isa))) {}

TraceDevice::~TraceDevice() = default;

namespace {

// The fastest of the settings measured; robust traversal is also the faster one for packets of 16.
RTCScene NewScene(RTCDevice device) {
  RTCScene scene = rtcNewScene(device);
  if (scene == nullptr) throw std::bad_alloc();
  rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_MEDIUM);
  return scene;
}

// Embree builds with the threads of the calling arena. A single thread is used, because the order
// of primitives in the leaves decides what a ray on an edge hits, and that order must not depend on
// how the work was shared.
void Commit(RTCScene scene) {
  tbb::task_arena one_thread(1);
  one_thread.execute([scene] { rtcCommitScene(scene); });
}

// Makes a new scene with the geometry that `attach` adds. Throws an InputError on failure.
template <typename Doing, typename Attach>
void BuildScene(RTCDevice device, RTCScene& scene, const Doing& doing, const Attach& attach) {
  // Clear an error left by an earlier failed build.
  static_cast<void>(rtcGetDeviceError(device));
  WithinMemory(doing, [&] {
    scene = NewScene(device);
    attach();
    Commit(scene);
  });
  ThrowIfFailed(device, doing);
}

struct ReleaseGeometry {
  void operator()(RTCGeometry geometry) const { rtcReleaseGeometry(geometry); }
};
using OwnedGeometry = std::unique_ptr<std::remove_pointer_t<RTCGeometry>, ReleaseGeometry>;

// Embree returns null where C++ throws std::bad_alloc; convert it.
OwnedGeometry NewGeometry(RTCDevice device, RTCGeometryType type) {
  OwnedGeometry geometry(rtcNewGeometry(device, type));
  if (geometry == nullptr) throw std::bad_alloc();
  return geometry;
}

void AttachPart(RTCDevice device, RTCScene scene, const Part& part, unsigned geometry_id) {
  const Mesh& mesh = part.mesh;
  const OwnedGeometry owned = NewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  RTCGeometry geometry = owned.get();
  if (!mesh.triangles.empty()) {
    using Corner = std::array<float, 3>;
    auto* vertices = static_cast<Corner*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                sizeof(Corner), mesh.vertices.size()));
    using Triangle = std::array<std::uint32_t, 3>;
    auto* triangles = static_cast<Triangle*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                sizeof(Triangle), mesh.triangles.size()));
    if (vertices == nullptr || triangles == nullptr) throw std::bad_alloc();
    std::transform(mesh.vertices.begin(), mesh.vertices.end(), vertices,
                   [](const Eigen::Vector3f& vertex) {
                     return Corner{vertex.x(), vertex.y(), vertex.z()};
                   });
    std::copy(mesh.triangles.begin(), mesh.triangles.end(), triangles);
  }
  rtcSetGeometryMask(geometry, part.is_wire ? kWireSurfaces : 0x1U);
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene, geometry, geometry_id);
}

}  // namespace

struct TraceModel::Handle {
  std::shared_ptr<TraceDevice::Handle> device;
  RTCScene scene{};

  ~Handle() {
    if (scene != nullptr) rtcReleaseScene(scene);
  }
};

TraceModel::TraceModel(const TraceDevice& device, const Model& model)
    : handle_(std::make_unique<Handle>()) {
  handle_->device = device.handle();
  RTCDevice const embree = handle_->device->device;
  const auto doing = [&] {
    return "building \"" + ShownText(model.name) + "\" for ray tracing (" +
           std::to_string(model.num_triangles()) + " triangles)";
  };
  BuildScene(embree, handle_->scene, doing, [&] {
    for (std::size_t i = 0; i < model.parts.size(); ++i) {
      AttachPart(embree, handle_->scene, model.parts[i], static_cast<unsigned>(i));
    }
  });
}

TraceModel::~TraceModel() = default;

namespace {

/// Columns of a rotation, padded so that each can be loaded as one vector.
struct alignas(16) RotationColumns {
  float x[4], y[4], z[4];
};

/// Data of one instance needed to resolve hits on it.
struct InstanceRecord {
  RotationColumns rotation;         ///< window_from_model at shutter 0.
  RotationColumns rotation_change;  ///< Its change until shutter 1; 0 if stationary.
  std::uint32_t first_surface{};
  bool moves{};
};

RotationColumns ToColumns(const Eigen::Matrix3d& matrix) {
  RotationColumns columns{};
  for (int row = 0; row < 3; ++row) {
    columns.x[row] = static_cast<float>(matrix(row, 0));
    columns.y[row] = static_cast<float>(matrix(row, 1));
    columns.z[row] = static_cast<float>(matrix(row, 2));
  }
  return columns;
}

}  // namespace

struct TraceScene::Parts {
  std::shared_ptr<TraceDevice::Handle> device;
  // Referenced by the scene; kept alive here.
  std::vector<std::shared_ptr<const TraceModel>> models;
  std::vector<InstanceRecord> instances;
  RTCScene scene{};

  Parts() = default;
  ~Parts() {
    if (scene != nullptr) rtcReleaseScene(scene);
  }
  Parts(const Parts&) = delete;
  Parts& operator=(const Parts&) = delete;

  void AttachInstance(const TracePlacement& placement);
  void StoreHits(const RTCRayHit16& packet, RayTile& tile, std::size_t first) const;
};

void TraceScene::Parts::AttachInstance(const TracePlacement& placement) {
  const auto& steps = placement.window_from_model;
  Check(!steps.empty(), "a placement has a place");
  const OwnedGeometry owned = NewGeometry(device->device, RTC_GEOMETRY_TYPE_INSTANCE);
  RTCGeometry geometry = owned.get();
  rtcSetGeometryInstancedScene(geometry, placement.model->handle().scene);
  rtcSetGeometryTimeStepCount(geometry, static_cast<unsigned>(steps.size()));
  for (std::size_t step = 0; step < steps.size(); ++step) {
    const Eigen::Matrix<float, 3, 4> matrix = steps[step].matrix().topRows<3>().cast<float>();
    rtcSetGeometryTransform(geometry, static_cast<unsigned>(step), RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR,
                            matrix.data());
  }
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene, geometry, static_cast<unsigned>(instances.size()));

  const Eigen::Matrix3d begin = steps.front().linear();
  const Eigen::Matrix3d change = steps.back().linear() - begin;
  instances.push_back(InstanceRecord{.rotation = ToColumns(begin),
                                     .rotation_change = ToColumns(change),
                                     .first_surface = placement.first_surface,
                                     .moves = !change.isZero(0.0)});
  models.push_back(placement.model);
}

TraceScene::TraceScene(const TraceDevice& device, const std::vector<TracePlacement>& placements) {
  auto parts = std::make_unique<Parts>();
  parts->device = device.handle();
  const auto doing = [&] {
    return "building a scene for ray tracing (" + std::to_string(placements.size()) + " places)";
  };
  BuildScene(parts->device->device, parts->scene, doing, [&] {
    for (const TracePlacement& placement : placements) parts->AttachInstance(placement);
  });
  parts_ = std::move(parts);
}

TraceScene::~TraceScene() = default;

void TraceScene::Parts::StoreHits(const RTCRayHit16& packet,
                                  RayTile& tile,
                                  std::size_t first) const {
  for (std::size_t lane = 0; lane < kPacketSize; ++lane) {
    const unsigned geometry = packet.hit.geomID[lane];
    if (geometry == RTC_INVALID_GEOMETRY_ID) continue;
    const std::size_t ray = first + lane;
    const InstanceRecord& instance = instances[packet.hit.instID[0][lane]];
    // Embree returns the normal in the model's frame and not normalised.
    const float nx = packet.hit.Ng_x[lane];
    const float ny = packet.hit.Ng_y[lane];
    const float nz = packet.hit.Ng_z[lane];
    float normal[4];
    for (int i = 0; i < 4; ++i) {
      normal[i] =
          instance.rotation.x[i] * nx + instance.rotation.y[i] * ny + instance.rotation.z[i] * nz;
    }
    if (instance.moves) {
      const float shutter = tile.shutter[ray];
      for (int i = 0; i < 4; ++i) {
        normal[i] +=
            shutter * (instance.rotation_change.x[i] * nx + instance.rotation_change.y[i] * ny +
                       instance.rotation_change.z[i] * nz);
      }
    }
    tile.range_m[ray] = packet.ray.tfar[lane];
    tile.normal_x[ray] = normal[0];
    tile.normal_y[ray] = normal[1];
    tile.normal_z[ray] = normal[2];
    tile.surface[ray] = instance.first_surface + geometry;
  }
}

namespace {

void LoadRays(const RayTile& tile, std::size_t first, RTCRayHit16& packet) {
  constexpr std::size_t kBytes = kPacketSize * sizeof(float);
  std::memcpy(packet.ray.org_x, tile.origin_x + first, kBytes);
  std::memcpy(packet.ray.org_y, tile.origin_y + first, kBytes);
  std::memcpy(packet.ray.org_z, tile.origin_z + first, kBytes);
  std::memcpy(packet.ray.dir_x, tile.direction_x + first, kBytes);
  std::memcpy(packet.ray.dir_y, tile.direction_y + first, kBytes);
  std::memcpy(packet.ray.dir_z, tile.direction_z + first, kBytes);
  std::memcpy(packet.ray.time, tile.shutter + first, kBytes);
  std::memcpy(packet.ray.tfar, tile.range_m + first, kBytes);
  std::memset(packet.ray.tnear, 0, kBytes);
  std::memset(packet.ray.flags, 0, kBytes);
  // Needed because Debian's Embree is built with ray masks.
  std::fill_n(packet.ray.mask, kPacketSize, tile.mask);
  std::memset(packet.hit.geomID, 0xFF, kBytes);
  std::memset(packet.hit.instID, 0xFF, kBytes);
}

// Traces a tile packet by packet and passes each to `store(packet, first_ray)`.
template <typename Store>
void TracePackets(RTCScene scene, const RayTile& tile, const Store& store) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  alignas(64) int valid[kPacketSize];
  std::fill_n(valid, kPacketSize, -1);
  for (std::size_t first = 0; first < tile.num_rays; first += kPacketSize) {
    alignas(64) RTCRayHit16 packet;
    LoadRays(tile, first, packet);
    rtcIntersect16(valid, scene, &context, &packet);
    store(packet, first);
  }
}

}  // namespace

void TraceScene::Cast(RayTile& tile) const {
  if (parts_->instances.empty()) return;
  TracePackets(parts_->scene, tile, [&](const RTCRayHit16& packet, std::size_t first) {
    parts_->StoreHits(packet, tile, first);
  });
}

void TraceScene::CastRanges(RayTile& tile) const {
  if (parts_->instances.empty()) return;
  TracePackets(parts_->scene, tile, [&](const RTCRayHit16& packet, std::size_t first) {
    std::memcpy(tile.range_m + first, packet.ray.tfar, kPacketSize * sizeof(float));
  });
}

}  // namespace railcast
