#include "viewer/overlays/overlays.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>

#include "core/rail/base/rail_surfaces.h"
#include "core/scene/object_pieces.h"
#include "core/scene/part_gatherer.h"
#include "railcast/frame.h"
#include "railcast/material.h"

namespace railcast {
namespace {

bool IsOf(const Part& part, const SurfaceClass& surface) {
  return part.label == surface.label && part.material == surface.material;
}

bool IsShown(const Part& part, const RailSurfaces& surfaces) {
  const std::array<SurfaceClass, 4> hidden = {surfaces.leaf, surfaces.bark, surfaces.grass,
                                              surfaces.fastening};
  return std::ranges::none_of(hidden, [&](const SurfaceClass& s) { return IsOf(part, s); });
}

double Range_m(const Part& part, const RailSurfaces& surfaces) {
  const std::array<SurfaceClass, 3> bed = {surfaces.ballast, surfaces.sleeper_concrete,
                                           surfaces.sleeper_wood};
  return std::ranges::any_of(bed, [&](const SurfaceClass& s) { return IsOf(part, s); })
             ? kTrackBedRange_m
             : kSceneRange_m;
}

/// The parts of models that are shown. Each model is filtered once, because thousands of placements
/// share it.
class ShownModels {
 public:
  explicit ShownModels(const RailSurfaces& surfaces) : surfaces_(surfaces) {}

  const Model& Of(const std::shared_ptr<const Model>& model) {
    const auto [found, is_new] = shown_.try_emplace(model);
    if (is_new) found->second = OnlyShown(*model);
    return found->second;
  }
  [[nodiscard]] Model OnlyShown(const Model& model) const {
    Model shown;
    for (const Part& part : model.parts) {
      if (IsShown(part, surfaces_)) shown.parts.push_back(part);
    }
    return shown;
  }

 private:
  const RailSurfaces& surfaces_;
  std::map<std::shared_ptr<const Model>, Model> shown_;
};

// Keeps the triangles with a corner within `range_m` of the origin in plan, and the vertices that
// they use.
Mesh Near(const Mesh& mesh, double range_m) {
  constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();
  const auto most_m2 = static_cast<float>(range_m * range_m);
  std::vector<std::uint32_t> new_index(mesh.vertices.size(), kUnused);
  Mesh near;
  for (const std::array<std::uint32_t, 3>& triangle : mesh.triangles) {
    if (std::ranges::none_of(triangle, [&](std::uint32_t i) {
          return mesh.vertices[i].head<2>().squaredNorm() <= most_m2;
        })) {
      continue;
    }
    std::array<std::uint32_t, 3>& kept = near.triangles.emplace_back();
    for (std::size_t i = 0; i < 3; ++i) {
      std::uint32_t& index = new_index[triangle[i]];
      if (index == kUnused) {
        index = static_cast<std::uint32_t>(near.vertices.size());
        near.vertices.push_back(mesh.vertices[triangle[i]]);
      }
      kept[i] = index;
    }
  }
  return near;
}

}  // namespace

StandingScene GatherStandingScene(const Surroundings& surroundings, int home_chunk) {
  const RailWorld& world = *surroundings.world;
  const ScenarioSpec& scenario = surroundings.scenario;
  const RailSurfaces surfaces(LabelTable(scenario.labels), MaterialLibrary(scenario.materials));
  StandingScene composition{.world_from_home = world.WorldFromChunk(home_chunk), .parts = {}};
  const Transform home_from_world = composition.world_from_home.inverse();
  ShownModels shown(surfaces);
  PartGatherer gatherer;
  for (const int index : world.ChunksInReach(home_chunk, kSceneRange_m)) {
    const Transform home_from_chunk = home_from_world * world.WorldFromChunk(index);
    const Chunk chunk = world.BuildChunk(index);
    gatherer.Add(shown.OnlyShown(chunk.ground), Eigen::Affine3d(home_from_chunk));
    for (const Placement& placement : chunk.placements) {
      gatherer.Add(shown.Of(placement.model), home_from_chunk * placement.chunk_from_model);
    }
  }
  composition.parts = gatherer.TakeParts();
  for (Part& part : composition.parts) {
    part.mesh = Near(part.mesh, Range_m(part, surfaces) + RailWorld::kChunkLength_m / 2);
  }
  std::erase_if(composition.parts, [](const Part& part) { return part.mesh.triangles.empty(); });
  return composition;
}

std::vector<Part> GatherSceneObjects(const Surroundings& surroundings,
                                     const RecordedFrame& recorded) {
  if (!recorded.has_pose) return {};
  const RailWorld& world = *surroundings.world;
  const Transform sensor_from_world = recorded.frame.world_from_sensor.inverse();
  PartGatherer gatherer;
  for (std::size_t i = 0; i < world.objects().size(); ++i) {
    const SceneObject& object = world.objects()[i];
    const Transform sensor_from_object =
        sensor_from_world * world.WorldFromObject(i, recorded.frame.stamp_ns);
    if (object.is_ego || sensor_from_object.translation().norm() > kSceneRange_m) continue;
    const std::vector<Transform> world_from_pieces =
        world.WorldFromPieces(i, recorded.frame.stamp_ns);
    for (std::size_t piece = 0; piece < world_from_pieces.size(); ++piece) {
      gatherer.Add(*PieceOf(object, piece),
                   Eigen::Affine3d(sensor_from_world * world_from_pieces[piece]));
    }
  }
  return gatherer.TakeParts();
}

}  // namespace railcast
