#include "core/extras/recipe/structure_contacts.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "core/rail/line/line_place.h"
#include "core/scene/convex_body.h"

namespace railcast {
namespace {

constexpr std::array<std::string_view, 15> kWithoutContact = {
    "rail",         "sleeper", "ballast", "ground",       "grass",
    "tree",         "bush",    "road",    "contact_wire", "messenger_wire",
    "cable_trough", "dropper", "balise",  "slab_track",   "switch"};

// Structures belong to the chunk of their middle, whose ends they may reach beyond.
constexpr double kBeyondChunk_m = 10.0;

// What of an object must be free: its box without what may touch or sink in.
ConvexBody CoreOf(const Eigen::AlignedBox3d& box_m) {
  constexpr double kTouching_m = 0.05;
  constexpr double kSunk_m = 0.15;  // How deep a car on a ramp sinks in.
  const Vector3 size_m = box_m.sizes();
  const Vector3 sides_m = (0.25 * size_m).cwiseMin(kTouching_m);
  Eigen::AlignedBox3d core_m(box_m.min() + sides_m, box_m.max() - sides_m);
  core_m.min().z() = box_m.min().z() + std::min(kSunk_m, 0.5 * size_m.z());
  std::vector<Vector3> corners_m;
  constexpr int kNumCorners = 8;
  for (int i = 0; i < kNumCorners; ++i) {
    corners_m.push_back(core_m.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i)));
  }
  return MakeConvexBody(std::move(corners_m));
}

}  // namespace

StructureContacts::StructureContacts(std::shared_ptr<const RailWorld> world,
                                     const LabelTable& labels)
    : world_(std::move(world)) {
  for (const Label& label : labels.labels()) {
    if (std::ranges::find(kWithoutContact, label.name) == kWithoutContact.end()) {
      labels_.emplace(label.id, label.name);
    }
  }
}

void StructureContacts::AddTriangles(const Model& model,
                                     const Eigen::Affine3d& world_from_model,
                                     std::vector<Triangle>& triangles) const {
  for (const Part& part : model.parts) {
    if (!labels_.contains(part.label)) continue;
    for (const auto& indices : part.mesh.triangles) {
      Triangle& triangle = triangles.emplace_back();
      triangle.label = part.label;
      for (std::size_t k = 0; k < 3; ++k) {
        triangle.corners_world[k] =
            world_from_model * part.mesh.vertices[indices[k]].cast<double>();
        triangle.box_world.extend(triangle.corners_world[k]);
      }
    }
  }
}

const std::vector<StructureContacts::Triangle>& StructureContacts::TrianglesOf(int chunk) {
  const auto [entry, is_new] = chunks_.try_emplace(chunk);
  if (!is_new) return entry->second;
  // Coarser are ballast, ground and rails alone.
  const Chunk built = world_->BuildCoarserChunk(chunk, 1);
  const Eigen::Affine3d world_from_chunk(world_->WorldFromChunk(chunk).matrix());
  AddTriangles(built.ground, world_from_chunk, entry->second);
  for (const Placement& placement : built.placements) {
    AddTriangles(*placement.model, world_from_chunk * placement.chunk_from_model, entry->second);
  }
  return entry->second;
}

std::vector<const StructureContacts::Triangle*> StructureContacts::TrianglesNear(
    const Eigen::AlignedBox3d& box_world, double near_s_m) {
  const Alignment& line = world_->alignment();
  const double s_m = PlaceOnLine(line, box_world.center(), near_s_m).s_m;
  const double reach_m = 0.5 * box_world.diagonal().norm() + kBeyondChunk_m;
  const auto chunk_at = [&](double at_s_m) {
    const double last_s_m = std::nextafter(line.length_m(), 0.0);
    return static_cast<int>(std::clamp(at_s_m, 0.0, last_s_m) / RailWorld::kChunkLength_m);
  };
  std::vector<const Triangle*> near;
  for (int chunk = chunk_at(s_m - reach_m); chunk <= chunk_at(s_m + reach_m); ++chunk) {
    for (const Triangle& triangle : TrianglesOf(chunk)) {
      if (triangle.box_world.intersects(box_world)) near.push_back(&triangle);
    }
  }
  return near;
}

std::optional<std::string> StructureContacts::Find(const RailWorld& world,
                                                   std::size_t object,
                                                   std::int64_t time_ns) {
  const Eigen::AlignedBox3d bounds_m = world.objects()[object].model->Bounds();
  if (bounds_m.isEmpty()) return std::nullopt;
  const Transform world_from_object = world.WorldFromObject(object, time_ns);
  const std::vector<const Triangle*> near = TrianglesNear(bounds_m.transformed(world_from_object),
                                                          world.ObjectChainage_m(object, time_ns));
  if (near.empty()) return std::nullopt;
  const ConvexBody core = CoreOf(bounds_m);
  const Transform object_from_world = world_from_object.inverse();
  for (const Triangle* const triangle : near) {
    std::vector<Vector3> corners_m;
    for (const Vector3& corner : triangle->corners_world) {
      corners_m.push_back(object_from_world * corner);
    }
    const ConvexBody body = MakeConvexBody(std::move(corners_m));
    if (!core.box_m.intersects(body.box_m)) continue;
    constexpr double kReach_m = 1e-3;
    if (Gap_m(core, Transform::Identity(), body, kReach_m) > 0.0) continue;
    return labels_.at(triangle->label);
  }
  return std::nullopt;
}

}  // namespace railcast
