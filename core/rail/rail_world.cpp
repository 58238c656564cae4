#include "core/rail/rail_world.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/rail/catenary.h"
#include "core/rail/catenary_plan.h"
#include "core/rail/chunk_context.h"
#include "core/rail/chunk_grid.h"
#include "core/rail/infrastructure_models.h"
#include "core/rail/object_models.h"
#include "core/rail/terrain.h"
#include "core/rail/track_path.h"
#include "core/rail/track_structure.h"
#include "core/rail/vegetation.h"
#include "core/rail/world_check.h"
#include "core/scene/shapes.h"

namespace railcast {
namespace {

// From the vehicle's origin, which the home chunk is chosen by, to its sensor.
constexpr double kSensorReach_m = 10.0;
// Of crowns and cantilevers beyond the ground of the chunk they belong to.
constexpr double kOverhang_m = 8.0;

/// The line and the ways along it.
struct Ways {
  Alignment alignment;
  TrackPath vehicle;
  std::vector<TrackPath> objects;  ///< In the order of RailWorld::objects().
};

std::optional<SpeedProfile> MakeProfile(const MotionSpec& motion,
                                        double start_s_m,
                                        const std::string& place,
                                        ErrorList& errors) {
  try {
    return SpeedProfile(motion, start_s_m);
  } catch (const InputError& error) {
    AddBelow(place, error, errors);
    return std::nullopt;
  }
}

bool FollowsTrack(const ObjectSpec& object) {
  return object.type == "open_wagon" || object.type == "flat_wagon" || object.type == "tank_wagon";
}

TrackPose PoseOf(const ObjectSpec& object, const WorldSpec& world) {
  return {FindTrack(world, object.track)->offset_m + object.d_m, object.h_m,
          RadFromDeg(object.heading_deg), !FollowsTrack(object)};
}

// All faults of the line, the places on it and the speed profiles are reported together.
Ways MakeWays(const WorldSpec& world, const VehicleSpec& vehicle) {
  ErrorList errors;
  std::optional<Alignment> alignment;
  LineMeasures line{std::numeric_limits<double>::infinity(),
                    std::numeric_limits<double>::infinity()};
  try {
    alignment.emplace(world.alignment);
    line = {alignment->length_m(), alignment->tightest_radius_m()};
  } catch (const InputError& error) {
    AddBelow("/world/alignment", error, errors);
  }
  CheckWorld(world, vehicle, line, errors);
  const auto vehicle_profile =
      MakeProfile(vehicle.motion, vehicle.start_s_m, "/vehicle/motion", errors);
  std::vector<std::optional<SpeedProfile>> profiles;
  for (std::size_t i = 0; i < world.objects.size(); ++i) {
    const ObjectSpec& object = world.objects[i];
    profiles.push_back(MakeProfile(object.motion.value_or(MotionSpec{}), object.s_m,
                                   "/world/objects/" + std::to_string(i) + "/motion", errors));
  }
  errors.ThrowIfAny();

  // A vehicle looks where it goes.
  const double heading_rad = vehicle.motion.reverse ? std::numbers::pi : 0.0;
  const TrackPose pose{FindTrack(world, vehicle.track)->offset_m, 0.0, heading_rad, false};
  Ways ways{*alignment, TrackPath(pose, *vehicle_profile), {}};
  for (std::size_t i = 0; i < world.objects.size(); ++i) {
    ways.objects.emplace_back(PoseOf(world.objects[i], world), *profiles[i]);
  }
  return ways;
}

CatenaryPlan MakeCatenaryPlan(const WorldSpec& world, const Alignment& alignment) {
  try {
    return {world, alignment};
  } catch (const InputError& error) {
    ErrorList errors;
    AddBelow("/world", error, errors);
    errors.ThrowIfAny();
    throw;
  }
}

/// In the order of the spec; whether they move is not said yet.
std::vector<SceneObject> MakeObjects(const WorldSpec& world,
                                     const RailSurfaces& surfaces,
                                     const LabelTable& labels,
                                     const MaterialLibrary& materials) {
  ErrorList errors;
  std::vector<SceneObject> objects;
  for (std::size_t i = 0; i < world.objects.size(); ++i) {
    const ObjectSpec& spec = world.objects[i];
    try {
      objects.push_back({.name = spec.name,
                         .type = spec.type,
                         .label = ObjectLabel(spec, surfaces, labels),
                         .instance = static_cast<std::uint32_t>(i + 1),
                         .model = MakeObjectModel(spec, surfaces, labels, materials)});
    } catch (const InputError& error) {
      AddBelow("/world/objects/" + std::to_string(i) + ": ", error, errors);
    }
  }
  errors.ThrowIfAny();
  return objects;
}

SceneObject MakeEgo(const VehicleSpec& vehicle,
                    const RailSurfaces& surfaces,
                    const LabelTable& labels) {
  const std::uint32_t label = labels.Id("ego");
  Model model{"ego", {{{}, surfaces.box.material, label}}};
  for (const std::array<double, 6>& box : vehicle.ego_boxes_m) {
    model.parts.front().mesh.Append(
        MakeBox({Vector3(box[0], box[1], box[2]), Vector3(box[3], box[4], box[5])}));
  }
  return {.name = "ego",
          .type = "ego",
          .label = label,
          .model = std::make_shared<const Model>(std::move(model)),
          .is_ego = true};
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
};

RailWorld::RailWorld(const WorldSpec& world,
                     const VehicleSpec& vehicle,
                     const LabelTable& labels,
                     const MaterialLibrary& materials,
                     std::uint64_t seed) {
  Ways ways = MakeWays(world, vehicle);
  const RailSurfaces surfaces(labels, materials);
  std::vector<SceneObject> objects = MakeObjects(world, surfaces, labels, materials);
  for (std::size_t i = 0; i < objects.size(); ++i) objects[i].moves = ways.objects[i].moves();
  if (!vehicle.ego_boxes_m.empty()) {
    objects.push_back(MakeEgo(vehicle, surfaces, labels));
    objects.back().instance = static_cast<std::uint32_t>(objects.size());
    objects.back().moves = ways.vehicle.moves();
    ways.objects.push_back(ways.vehicle);
  }
  ChunkGrid grid(ways.alignment, kChunkLength_m, world.terrain.half_width_m);
  CatenaryPlan catenary_plan = MakeCatenaryPlan(world, ways.alignment);
  parts_ = std::make_unique<const Parts>(
      Parts{world, seed, surfaces, std::move(ways), std::move(grid), std::move(catenary_plan),
            MakeInfrastructureModels(world, surfaces), MakePlantModels(surfaces, seed),
            std::move(objects)});
}

RailWorld::~RailWorld() = default;

const Alignment& RailWorld::alignment() const {
  return parts_->ways.alignment;
}

Transform RailWorld::WorldFromVehicle(std::int64_t time_ns) const {
  return parts_->ways.vehicle.WorldFromObject(parts_->ways.alignment, time_ns);
}

int RailWorld::HomeChunk(std::int64_t time_ns) const {
  return parts_->grid.ChunkAt(parts_->ways.vehicle.ChainageAt(time_ns));
}

std::vector<int> RailWorld::ChunksInReach(int home_chunk, double range_m) const {
  const double aside_m = std::abs(parts_->ways.vehicle.pose().d_m);
  return parts_->grid.WithinReach(home_chunk, range_m + kSensorReach_m + aside_m + kOverhang_m);
}

Transform RailWorld::WorldFromChunk(int chunk) const {
  return parts_->grid.WorldFromChunk(chunk);
}

Chunk RailWorld::BuildChunk(int chunk) const {
  const ChunkContext context{parts_->world,
                             parts_->ways.alignment,
                             parts_->surfaces,
                             parts_->seed,
                             chunk,
                             parts_->grid.BeginOf(chunk),
                             parts_->grid.EndOf(chunk),
                             parts_->grid.WorldFromChunk(chunk).inverse()};
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
  return parts_->ways.objects.at(object).WorldFromObject(parts_->ways.alignment, time_ns);
}

}  // namespace railcast
