#pragma once

#include <tbb/task_arena.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <span>
#include <vector>

#include "core/trace/embree.h"
#include "railcast/scene.h"
#include "tests/support/ray_cast.h"

namespace railcast {

/// Embree as a simple simulator uses it: one scene of all parts, one ray at a time. Robust
/// traversal and a build with one thread, which TraceScene uses, can be chosen for comparison.
class PlainEmbree {
 public:
  PlainEmbree(std::span<const Part> parts, RTCSceneFlags flags, int num_build_threads)
      : device_(rtcNewDevice("")), scene_(rtcNewScene(device_)) {
    rtcSetSceneFlags(scene_, flags);
    for (const Part& part : parts) Attach(part.mesh);
    tbb::task_arena arena(num_build_threads);
    arena.execute([this] { rtcCommitScene(scene_); });
  }
  ~PlainEmbree() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  PlainEmbree(const PlainEmbree&) = delete;
  PlainEmbree& operator=(const PlainEmbree&) = delete;

  /// Part i is surface i + 1.
  [[nodiscard]] std::vector<RayHit> Cast(std::span<const Ray> rays) const {
    std::vector<RayHit> hits;
    for (const Ray& ray : rays) {
      RayQueryContext context;
      InitContext(context);
      RTCRayHit query{};
      query.ray.org_x = ray.origin_m.x();
      query.ray.org_y = ray.origin_m.y();
      query.ray.org_z = ray.origin_m.z();
      query.ray.dir_x = ray.direction.x();
      query.ray.dir_y = ray.direction.y();
      query.ray.dir_z = ray.direction.z();
      query.ray.tfar = std::numeric_limits<float>::infinity();
      query.ray.mask = ~0U;
      query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
      query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
      RayQuery(context).Intersect1(scene_, query);
      hits.push_back({query.ray.tfar, query.hit.geomID + 1});  // The invalid id + 1 = 0.
    }
    return hits;
  }

 private:
  void Attach(const Mesh& mesh) {
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    void* vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                             sizeof(mesh.vertices[0]), mesh.vertices.size());
    std::ranges::copy(mesh.vertices, static_cast<Eigen::Vector3f*>(vertices));
    void* triangles = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                              sizeof(mesh.triangles[0]), mesh.triangles.size());
    std::memcpy(triangles, mesh.triangles.data(),
                mesh.triangles.size() * sizeof(mesh.triangles[0]));
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
  }

  RTCDevice device_;
  RTCScene scene_;
};

}  // namespace railcast
