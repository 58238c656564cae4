#include "core/rail/rail_world.h"

#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/rail/catenary/catenary.h"
#include "core/rail/catenary/catenary_plan.h"
#include "core/rail/chunk_context.h"
#include "core/rail/chunk_grid.h"
#include "core/rail/infrastructure_models.h"
#include "core/rail/land/terrain.h"
#include "core/rail/land/vegetation.h"
#include "core/rail/line/track_path.h"
#include "core/rail/objects/object_models.h"
#include "core/rail/standing_height.h"
#include "core/rail/track/track_structure.h"
#include "core/rail/world_check.h"
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

// What `make` returns; or nothing, and the lines of its error with `place` put before them.
template <typename Make>
auto Attempt(const std::string& place, ErrorList& errors, Make make)
    -> std::optional<decltype(make())> {
  try {
    return make();
  } catch (const InputError& error) {
    std::istringstream lines(error.what());
    for (std::string line; std::getline(lines, line);) errors.Add(place + line);
    return std::nullopt;
  }
}

bool FollowsTrack(const ObjectSpec& object) {
  return object.type == "open_wagon" || object.type == "flat_wagon" || object.type == "tank_wagon";
}

TrackPose PoseOf(const ObjectSpec& object, const WorldSpec& world) {
  return {FindTrack(world, object.track)->offset_m + object.d_m, object.h_m.value_or(0.0),
          RadFromDeg(object.heading_deg), !FollowsTrack(object)};
}

// All faults of the line, the places on it and the speed profiles are reported together.
Ways MakeWays(const WorldSpec& world, const VehicleSpec& vehicle) {
  ErrorList errors;
  const auto alignment =
      Attempt("/world/alignment", errors, [&] { return Alignment(world.alignment); });
  // Without a line there is nothing to be beyond of.
  constexpr double kEndless_m = std::numeric_limits<double>::infinity();
  const LineMeasures line =
      alignment ? LineMeasures{alignment->length_m(), alignment->tightest_radius_m()}
                : LineMeasures{kEndless_m, kEndless_m};
  CheckWorld(world, vehicle, line, errors);
  const auto vehicle_profile = Attempt(
      "/vehicle/motion", errors, [&] { return SpeedProfile(vehicle.motion, vehicle.start_s_m); });
  std::vector<std::optional<SpeedProfile>> profiles;
  for (std::size_t i = 0; i < world.objects.size(); ++i) {
    const ObjectSpec& object = world.objects[i];
    profiles.push_back(Attempt("/world/objects/" + std::to_string(i) + "/motion", errors, [&] {
      return SpeedProfile(object.motion.value_or(MotionSpec{}), object.s_m);
    }));
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

/// What a scenario's objects are made from.
struct Tables {
  const RailSurfaces& surfaces;
  const LabelTable& labels;
  const MaterialLibrary& materials;
};

SceneObject MakeObject(const ObjectSpec& spec, const TrackPath& path, const Tables& tables) {
  return {.name = spec.name,
          .type = spec.type,
          .label = ObjectLabel(spec, tables.surfaces, tables.labels),
          .model = MakeObjectModel(spec, tables.surfaces, tables.labels, tables.materials),
          .moves = path.moves()};
}

SceneObject MakeEgo(const VehicleSpec& vehicle, const TrackPath& path, const Tables& tables) {
  const std::uint32_t label = tables.labels.Id("ego");
  Model model{"ego", {{{}, tables.surfaces.box.material, label}}};
  for (const std::array<double, 6>& box : vehicle.ego_boxes_m) {
    model.parts.front().mesh.Append(
        MakeBox({Vector3(box[0], box[1], box[2]), Vector3(box[3], box[4], box[5])}));
  }
  return {.name = "ego",
          .type = "ego",
          .label = label,
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
  Ways ways = MakeWays(world, vehicle);
  const RailSurfaces surfaces(labels, materials);
  const Tables tables{surfaces, labels, materials};
  ErrorList errors;
  std::vector<SceneObject> objects;
  for (std::size_t i = 0; i < world.objects.size(); ++i) {
    auto object = Attempt("/world/objects/" + std::to_string(i) + ": ", errors,
                          [&] { return MakeObject(world.objects[i], ways.objects[i], tables); });
    if (object) objects.push_back(std::move(*object));
  }
  auto catenary_plan =
      Attempt("/world", errors, [&] { return CatenaryPlan(world, ways.alignment); });
  errors.ThrowIfAny();

  if (!vehicle.ego_boxes_m.empty()) {
    objects.push_back(MakeEgo(vehicle, ways.vehicle, tables));
    ways.objects.push_back(ways.vehicle);
  }
  std::vector<std::optional<Eigen::AlignedBox2d>> footprints_m;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    objects[i].instance = static_cast<std::uint32_t>(i + 1);
    const bool stands_on_ground =
        !objects[i].is_ego && !world.objects[i].h_m && !FollowsTrack(world.objects[i]);
    footprints_m.push_back(stands_on_ground ? std::optional(FootprintOf(*objects[i].model))
                                            : std::nullopt);
  }
  ChunkGrid grid(ways.alignment, kChunkLength_m, world.terrain.half_width_m);
  parts_ = std::make_unique<const Parts>(
      Parts{world, seed, surfaces, std::move(ways), std::move(grid), std::move(*catenary_plan),
            MakeInfrastructureModels(world, surfaces), MakePlantModels(surfaces, seed),
            std::move(objects), std::move(footprints_m)});
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
