
#include <algorithm>
#include <array>
#include <cstdint>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include "core/base/text.h"
#include "core/trace/embree.h"
#include "core/trace/trace_handles.h"
#include "core/trace/trace_program.h"
#include "core/trace/trace_scene.h"

namespace railcast {

TraceDevice::TraceDevice(const std::string& isa)
    : handle_(std::make_shared<Handle>(isa.empty() ? "" : "isa=" + IsaInUse(isa))) {}

TraceDevice::~TraceDevice() = default;

namespace {

using Corner = std::array<float, 3>;
using Triangle = std::array<std::uint32_t, 3>;

void AttachPart(RTCDevice device, RTCScene scene, const Part& part, unsigned geometry_id) {
  const Mesh& mesh = part.mesh;
  const OwnedGeometry owned = NewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  RTCGeometry geometry = owned.get();
  if (!mesh.triangles.empty()) {
    auto* vertices = static_cast<Corner*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                sizeof(Corner), mesh.vertices.size()));
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

bool HasLabel(const PartSize& part, const LabelsOfBeams& labels) {
  if (!labels || std::ranges::find(*labels, part.label) != labels->end()) return true;
  // The tube that stands for any wire in the wind has none.
  return part.is_wire && part.label == 0;
}

// The triangles of the wires, or of all else, in an Embree scene that AttachPart() has filled, with
// the parts they belong to.
std::vector<BeamTriangle> TrianglesOf(RTCScene scene,
                                      const std::vector<PartSize>& parts,
                                      const LabelsOfBeams& labels,
                                      bool are_wires) {
  std::vector<BeamTriangle> triangles;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    if (parts[p].num_triangles == 0 || parts[p].is_wire != are_wires) continue;
    if (!HasLabel(parts[p], labels)) continue;
    RTCGeometry geometry = rtcGetGeometry(scene, static_cast<unsigned>(p));
    const auto* const vertices =
        static_cast<const Corner*>(rtcGetGeometryBufferData(geometry, RTC_BUFFER_TYPE_VERTEX, 0));
    const auto* const indices =
        static_cast<const Triangle*>(rtcGetGeometryBufferData(geometry, RTC_BUFFER_TYPE_INDEX, 0));
    for (std::size_t i = 0; i < parts[p].num_triangles; ++i) {
      BeamTriangle& triangle = triangles.emplace_back();
      triangle.part = static_cast<std::uint32_t>(p);
      for (std::size_t k = 0; k < 3; ++k) {
        triangle.corners[k] = Eigen::Vector3f(vertices[indices[i][k]].data());
      }
    }
  }
  return triangles;
}

}  // namespace

std::string TraceModel::Handle::Doing() const {
  std::size_t num_triangles = 0;
  for (const PartSize& part : parts) num_triangles += part.num_triangles;
  return "building \"" + ShownText(name) + "\" for ray tracing (" + std::to_string(num_triangles) +
         " triangles)";
}

const BeamTrees& TraceModel::Handle::beam_trees(const LabelsOfBeams& labels) const {
  const std::scoped_lock lock(beam_trees_mutex_);
  const auto known = beam_trees_.find(labels);
  if (known != beam_trees_.end()) return known->second;
  BeamTrees trees;
  const auto doing = [this] { return Doing() + " in beams"; };
  BuildWithEmbree(device->device, doing, [&] {
    trees.solid = BuildModelTree(device->device, TrianglesOf(scene, parts, labels, false));
    trees.wires = BuildModelTree(device->device, TrianglesOf(scene, parts, labels, true));
  });
  return beam_trees_.emplace(labels, std::move(trees)).first->second;
}

TraceModel::TraceModel(const TraceDevice& device, const Model& model, bool is_passable)
    : handle_(std::make_unique<Handle>()) {
  handle_->device = device.handle();
  handle_->name = model.name;
  handle_->is_foliage = model.is_foliage;
  const Eigen::AlignedBox3d box_m = model.Bounds();
  handle_->box_m =
      box_m.isEmpty() ? Eigen::AlignedBox3f(Eigen::Vector3f::Zero().eval()) : box_m.cast<float>();
  for (const Part& part : model.parts) {
    handle_->parts.push_back({part.mesh.triangles.size(), part.label, part.is_wire});
  }
  RTCDevice const embree = handle_->device->device;
  const auto doing = [&] { return handle_->Doing(); };
  RTCSceneFlags flags = model.is_foliage ? kOpen : kWatertight;
  if (is_passable) flags = flags | kFilteredByQuery;
  BuildScene(embree, flags, handle_->scene, doing, [&] {
    for (std::size_t i = 0; i < model.parts.size(); ++i) {
      AttachPart(embree, handle_->scene, model.parts[i], static_cast<unsigned>(i));
    }
  });
}

TraceModel::~TraceModel() = default;

}  // namespace railcast
