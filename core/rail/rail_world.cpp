#include "core/rail/rail_world.h"

#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/rail/catenary/catenary.h"
#include "core/rail/catenary/catenary_plan.h"
#include "core/rail/chunk_context.h"
#include "core/rail/chunk_grid.h"
#include "core/rail/infrastructure_models.h"
#include "core/rail/land/terrain.h"
#include "core/rail/land/vegetation.h"
#include "core/rail/line/track_path.h"
#include "core/rail/standing_height.h"
#include "core/rail/track/track_structure.h"
#include "core/rail/world_draft.h"
#include "core/scene/shapes.h"

namespace railcast {
namespace {

// Of crowns and cantilevers beyond the ground of the chunk they belong to.
constexpr double kOverhang_m = 8.0;

/// The line and the ways along it.
struct Ways {
  Alignment alignment;
  TrackPath vehicle;
  std::vector<TrackPath> objects;  ///< In the order of RailWorld::objects().
};

bool StandsOnGround(const ObjectSpec& object) {
  return !object.h_m && !object.type.ends_with("_wagon");
}

SceneObject MakeEgo(const VehicleSpec& vehicle,
                    const TrackPath& path,
                    const SurfaceClass& surface) {
  Model model{"ego", {{{}, surface.material, surface.label}}};
  for (const std::array<double, 6>& box : vehicle.ego_boxes_m) {
    model.parts.front().mesh.Append(
        MakeBox({Vector3(box[0], box[1], box[2]), Vector3(box[3], box[4], box[5])}));
  }
  return {.name = "ego",
          .type = "ego",
          .label = surface.label,
          .model = std::make_shared<const Model>(std::move(model)),
          .moves = path.moves(),
          .is_ego = true};
}

Eigen::AlignedBox2d FootprintOf(const Model& model) {
  const Eigen::AlignedBox3d bounds_m = model.Bounds();
  return {bounds_m.min().head<2>(), bounds_m.max().head<2>()};
}

}  // namespace

struct RailWorld::Parts {
  WorldSpec world;
  std::uint64_t seed{};
  RailSurfaces surfaces;
  Ways ways;
  ChunkGrid grid;
  CatenaryPlan catenary_plan;
  InfrastructureModels infrastructure;
  PlantModels plants;
  std::vector<SceneObject> objects;
  /// By object: what it covers of the ground it stands on; empty where its height is given.
  std::vector<std::optional<Eigen::AlignedBox2d>> footprints_m;

  /// With `chunk_from_world` the identity, builders work in world coordinates.
  [[nodiscard]] ChunkContext ContextOf(int chunk, const Transform& chunk_from_world) const {
    return {world, ways.alignment,      surfaces,          seed,
            chunk, grid.BeginOf(chunk), grid.EndOf(chunk), chunk_from_world};
  }
};

RailWorld::RailWorld(const WorldSpec& world,
                     const VehicleSpec& vehicle,
                     const LabelTable& labels,
                     const MaterialLibrary& materials,
                     std::uint64_t seed) {
  WorldFaults faults;
  WorldDraft draft = DraftWorld({world, vehicle, labels, materials}, faults);
  faults.errors.ThrowIfAny();

  const RailSurfaces surfaces = *draft.surfaces;
  Ways ways{*draft.alignment, *draft.vehicle_path, std::move(draft.object_paths)};
  std::vector<SceneObject> objects = std::move(draft.objects);
  if (!vehicle.ego_boxes_m.empty()) {
    objects.push_back(MakeEgo(vehicle, ways.vehicle, {surfaces.box.material, labels.Id("ego")}));
    ways.objects.push_back(ways.vehicle);
  }
  std::vector<std::optional<Eigen::AlignedBox2d>> footprints_m;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    objects[i].instance = static_cast<std::uint32_t>(i + 1);
    const bool stands_on_ground = !objects[i].is_ego && StandsOnGround(world.objects[i]);
    footprints_m.push_back(stands_on_ground ? std::optional(FootprintOf(*objects[i].model))
                                            : std::nullopt);
  }
  ChunkGrid grid(ways.alignment, kChunkLength_m, world.terrain.half_width_m);
  parts_ = std::make_unique<const Parts>(
      Parts{world, seed, surfaces, std::move(ways), std::move(grid),
            std::move(*draft.catenary_plan), MakeInfrastructureModels(world, surfaces),
            MakePlantModels(surfaces, seed), std::move(objects), std::move(footprints_m)});
}

RailWorld::~RailWorld() = default;

const Alignment& RailWorld::alignment() const {
  return parts_->ways.alignment;
}

double RailWorld::VehicleChainage_m(std::int64_t time_ns) const {
  return parts_->ways.vehicle.ChainageAt(time_ns);
}

double RailWorld::ObjectChainage_m(std::size_t object, std::int64_t time_ns) const {
  return parts_->ways.objects.at(object).ChainageAt(time_ns);
}

Transform RailWorld::WorldFromVehicle(std::int64_t time_ns) const {
  return parts_->ways.vehicle.WorldFromObject(parts_->ways.alignment, time_ns);
}

int RailWorld::HomeChunk(std::int64_t time_ns) const {
  return parts_->grid.ChunkAt(parts_->ways.vehicle.ChainageAt(time_ns));
}

std::vector<int> RailWorld::ChunksInReach(int home_chunk, double range_m) const {
  const double aside_m = std::abs(parts_->ways.vehicle.pose().d_m);
  return parts_->grid.WithinReach(home_chunk, range_m + aside_m + kOverhang_m);
}

Transform RailWorld::WorldFromChunk(int chunk) const {
  return parts_->grid.WorldFromChunk(chunk);
}

Chunk RailWorld::BuildChunk(int chunk) const {
  const ChunkContext context =
      parts_->ContextOf(chunk, parts_->grid.WorldFromChunk(chunk).inverse());
  Chunk built;
  built.ground.name = "chunk " + std::to_string(chunk);
  AddTerrain(context, built);
  AddTracks(context, parts_->infrastructure, built);
  AddCatenary(context, parts_->catenary_plan, parts_->infrastructure, built);
  AddVegetation(context, parts_->plants, built);
  return built;
}

const std::vector<SceneObject>& RailWorld::objects() const {
  return parts_->objects;
}

Transform RailWorld::WorldFromObject(std::size_t object, std::int64_t time_ns) const {
  const TrackPath& path = parts_->ways.objects.at(object);
  Transform world_from_object = path.WorldFromObject(parts_->ways.alignment, time_ns);
  if (const auto& area_m = parts_->footprints_m[object]) {
    const double s_m = path.ChainageAt(time_ns);
    const Footprint footprint{s_m, path.pose().d_m, path.pose().heading_rad, *area_m};
    const int chunk = parts_->grid.ChunkAt(s_m);
    world_from_object.translation().z() =
        StandingHeight_m(parts_->ContextOf(chunk, Transform::Identity()), footprint);
  }
  return world_from_object;
}

}  // namespace railcast
