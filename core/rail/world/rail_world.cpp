#include "railcast/rail_world.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/out_of_memory.h"
#include "core/base/text.h"
#include "core/rail/catenary/catenary.h"
#include "core/rail/catenary/catenary_plan.h"
#include "core/rail/chunk/chunk_context.h"
#include "core/rail/chunk/chunk_grid.h"
#include "core/rail/clearance/cleared.h"
#include "core/rail/ground/plant_models.h"
#include "core/rail/ground/terrain.h"
#include "core/rail/landform/landform.h"
#include "core/rail/motion/ride.h"
#include "core/rail/motion/track_path.h"
#include "core/rail/network/network_draft.h"
#include "core/rail/objects/mesh_object.h"
#include "core/rail/structures/standing_height.h"
#include "core/rail/structures/structures.h"
#include "core/rail/survey/surveyed_scene.h"
#include "core/rail/track/track_structure.h"
#include "core/rail/traffic/object_draft.h"
#include "core/rail/traffic/object_way.h"
#include "core/rail/traffic/trains.h"
#include "core/rail/world/world_draft.h"
#include "core/scene/rotation_between.h"

namespace railcast {
namespace {

// Maximum extent of tree crowns and cantilevers beyond the ground of their chunk.
constexpr double kOverhang_m = 8.0;

}  // namespace

/// The part of the world that commands cannot change.
struct RailWorld::Line {
  WorldSpec world;
  VehicleSpec vehicle;
  LabelTable labels;
  MaterialLibrary materials;
  std::uint64_t seed{};
  std::optional<RailSurfaces> surfaces;
  Alignment alignment;
  Network network;
  std::vector<LaidTurnout> turnouts;
  std::vector<LaidDiamond> diamonds;
  ChunkGrid grid;
  CatenaryPlan catenary_plan;
  TrackModels track_models;
  std::shared_ptr<const Model> mast_model;
  std::unique_ptr<const PlantsOnDemand> plants;
  Landform land;
  std::optional<Ride> ride;                     ///< Of the sensor's vehicle.
  std::shared_ptr<const SurveyedScene> survey;  ///< Null: the line is built from the spec.
  TilesOfChunks surveyed;

  /// If `chunk_from_world` is the identity, builders work in world coordinates.
  [[nodiscard]] ChunkContext ContextOf(int chunk, const Transform& chunk_from_world) const {
    return {.spec = world,
            .alignment = alignment,
            .tracks = network.courses,
            .turnouts = turnouts,
            .surfaces = *surfaces,
            .seed = seed,
            .chunk = chunk,
            .begin_s_m = grid.BeginOf(chunk),
            .end_s_m = grid.EndOf(chunk),
            .chunk_from_world = chunk_from_world,
            .land = &land,
            .diamonds = diamonds,
            .survey = survey.get()};
  }
  [[nodiscard]] bool has_plants() const {
    const VegetationSpec& spec = world.vegetation;
    return !survey && (spec.grass || spec.trees_per_hectare > 0.0 || spec.bushes_per_hectare > 0.0);
  }
  [[nodiscard]] static ClearedAreas UnballastedAbout(const ChunkContext& context) {
    // Cross-sections beyond are few.
    constexpr double kBeyond_m = 10.0;
    return {TracksOf(context), Clearing::kBallast, context.begin_s_m - kBeyond_m,
            context.end_s_m + kBeyond_m};
  }
  [[nodiscard]] Chunk Build(ChunkContext context) const {
    Chunk built;
    const ClearedAreas unballasted = UnballastedAbout(context);
    context.unballasted = &unballasted;
    built.ground.name = "chunk " + std::to_string(context.chunk);
    WithinMemory([&] { return "building " + built.ground.name + " of the line"; },
                 [&] {
                   if (survey) {
                     survey->Add(surveyed.tiles.at(static_cast<std::size_t>(context.chunk)),
                                 context.chunk_from_world, built);
                     AddStructures(context, built);
                     return;
                   }
                   AddTerrain(context, built);
                   AddTracks(context, track_models, built);
                   AddCatenary(context, catenary_plan, mast_model, built);
                   AddStructures(context, built);
                   if (has_plants()) AddVegetation(context, plants->Get(), built);
                 });
    return built;
  }
  /// The booms of all level crossings whose barriers move.
  [[nodiscard]] std::vector<MovingBoom> Booms() const {
    std::vector<MovingBoom> booms;
    for (const StructureSpec& structure : world.structures) {
      const auto* crossing = std::get_if<LevelCrossingSpec>(&structure);
      if (crossing == nullptr || crossing->barrier_angles_deg.empty()) continue;
      const int chunk = grid.ChunkAt(crossing->s_m);
      ChunkContext context = ContextOf(chunk, grid.WorldFromChunk(chunk).inverse());
      const ClearedAreas unballasted = UnballastedAbout(context);
      context.unballasted = &unballasted;
      for (MovingBoom& boom : MovingBoomsOf(context, *crossing)) booms.push_back(std::move(boom));
    }
    return booms;
  }
  /// The sensor's vehicle, of which everything but its bogies moves on their springs.
  [[nodiscard]] Transform WorldFromVehicle(const TrackPath& path, double s_m, double v_mps) const {
    const Transform world_from_perfect = path.WorldFromObjectAt(alignment, s_m);
    if (!ride) return world_from_perfect;
    return world_from_perfect * ride->PerfectFromVehicle(ride->At(s_m, v_mps, path.reverse()));
  }
  [[nodiscard]] LineMeasures Measures() const {
    return {alignment.length_m(), alignment.tightest_radius_m()};
  }
};

/// The objects, and the motion of everything that moves.
struct RailWorld::Things {
  TrackPath vehicle;
  bool has_changed_vehicle_speed = false;
  // Shared between worlds, because most commands change only the vehicle's motion.
  std::shared_ptr<const std::vector<SceneObject>> objects;
  std::shared_ptr<const std::vector<ObjectWay>> ways;  ///< In the order of `objects`.
  std::uint32_t next_instance = 1;

  [[nodiscard]] const TrackPath& PathOf(std::size_t object) const {
    const std::optional<TrackPath>& path = ways->at(object).path;
    return path ? *path : vehicle;
  }
};

RailWorld::RailWorld(std::shared_ptr<const Line> line, std::shared_ptr<const Things> things)
    : line_(std::move(line)), things_(std::move(things)) {}

RailWorld::RailWorld(const WorldSpec& world,
                     const VehicleSpec& vehicle,
                     const LabelTable& labels,
                     const MaterialLibrary& materials,
                     std::uint64_t seed) {
  WorldFaults faults;
  WorldDraft draft = DraftWorld({world, vehicle, labels, materials}, faults);
  faults.errors.ThrowIfAny();

  const RailSurfaces& surfaces = *draft.surfaces;
  const Alignment& alignment = *draft.alignment;
  std::vector<TrackPath> boom_paths = BoomPaths(draft);
  Network network = Completed(std::move(draft.network));
  std::vector<LaidTurnout> turnouts = LayTurnouts(network);
  std::vector<LaidDiamond> diamonds = LayDiamonds(network);
  const ChunkGrid grid(alignment, kChunkLength_m, world.terrain.half_width_m);
  TilesOfChunks surveyed;
  if (draft.survey) surveyed = draft.survey->AssignTiles(alignment, grid);
  line_ = std::make_shared<const Line>(
      Line{std::move(draft.world), vehicle, labels, materials, seed, surfaces, alignment,
           std::move(network), std::move(turnouts), std::move(diamonds), grid,
           std::move(*draft.catenary_plan), MakeTrackModels(world.alignment, surfaces),
           std::make_shared<const Model>(MakeMast(world.catenary, surfaces)),
           std::make_unique<const PlantsOnDemand>(surfaces, seed),
           Landform(world.terrain, std::move(*draft.strip_width), std::move(draft.elevation), seed),
           RideOf(vehicle, world.seed), std::move(draft.survey), std::move(surveyed)});

  std::vector<SceneObject> objects = std::move(draft.objects);
  std::vector<ObjectWay> ways;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    if (i < world.objects.size()) {
      ways.push_back(WayOf(world.objects[i], *objects[i].model, std::move(draft.object_paths[i])));
    } else {
      ways.push_back({.path = std::move(draft.object_paths[i].track), .is_in_train = true});
    }
  }
  if (!vehicle.ego_boxes_m.empty()) {
    objects.push_back(
        MakeEgoBoxes(vehicle, *draft.vehicle_path, {surfaces.box.material, labels.Id("ego")}));
    ways.emplace_back();
  } else if (!vehicle.consist.empty()) {
    ObjectModels models(surfaces, labels, materials);
    for (TrainVehicle& own :
         MakeEgoTrain(vehicle, *draft.vehicle_path, alignment, labels.Id("ego"), models)) {
      objects.push_back(std::move(own.object));
      ways.push_back({.path = std::move(own.path)});
    }
  }
  std::size_t boom_index = 0;
  for (MovingBoom& boom : line_->Booms()) {
    objects.push_back({.name = boom.name,
                       .type = "barrier",
                       .label = surfaces.structures.lineside.barrier_red.label,
                       .model = boom.model,
                       .moves = true});
    ways.push_back({.path = std::move(boom_paths.at(boom_index++)), .boom = std::move(boom)});
  }
  std::uint32_t next_instance = 1;
  for (SceneObject& object : objects) object.instance = next_instance++;
  things_ = std::make_shared<const Things>(
      Things{*draft.vehicle_path, false,
             std::make_shared<const std::vector<SceneObject>>(std::move(objects)),
             std::make_shared<const std::vector<ObjectWay>>(std::move(ways)), next_instance});
}

RailWorld::~RailWorld() = default;

void RailWorld::PreparePlants() const {
  if (line_->has_plants()) static_cast<void>(line_->plants->Get());
}

std::shared_ptr<const RailWorld> RailWorld::WithVehicleSpeed(std::int64_t from_ns,
                                                             double speed_mps,
                                                             double acceleration_mps2) const {
  Things changed = *things_;
  changed.vehicle = changed.vehicle.WithSpeedFrom(from_ns, speed_mps, acceleration_mps2);
  changed.has_changed_vehicle_speed = true;
  auto ways = std::make_shared<std::vector<ObjectWay>>(*changed.ways);
  for (std::size_t i = 0; i < ways->size(); ++i) {
    ObjectWay& way = (*ways)[i];
    if (way.walk) way.walk = way.walk->WithVehicle(changed.vehicle, from_ns);
    // The other vehicles of the sensor's train.
    if (way.path && (*changed.objects)[i].is_ego) {
      way.path = way.path->WithSpeedFrom(from_ns, speed_mps, acceleration_mps2);
    }
  }
  changed.ways = std::move(ways);
  const auto standing_ego = [](const SceneObject& object) {
    return object.is_ego && !object.moves;
  };
  if (std::any_of(changed.objects->begin(), changed.objects->end(), standing_ego)) {
    auto objects = std::make_shared<std::vector<SceneObject>>(*changed.objects);
    // From now on its place depends on time, even after it has stopped again.
    for (SceneObject& object : *objects) object.moves = object.moves || object.is_ego;
    changed.objects = std::move(objects);
  }
  return std::shared_ptr<const RailWorld>(
      new RailWorld(line_, std::make_shared<const Things>(std::move(changed))));
}

std::shared_ptr<const RailWorld> RailWorld::WithObject(const ObjectSpec& given,
                                                       std::int64_t from_ns) const {
  const std::string pointer = "/object";
  WorldFaults faults;
  const std::vector<std::optional<TrackCourse>> courses(line_->network.courses.begin(),
                                                        line_->network.courses.end());
  const NetworkDraft network{courses, line_->network.turnouts};
  ObjectSpec object = given;
  PlaceFromMap({line_->world, network, &line_->alignment}, pointer, object, faults);
  CheckObject(line_->world, object, pointer, {line_->Measures(), courses}, faults);
  const auto has_its_name = [&](const SceneObject& other) { return other.name == object.name; };
  if (object.name == "ego" || std::any_of(objects().begin(), objects().end(), has_its_name)) {
    faults.Add(pointer + "/name",
               std::string("must be unique") +
                   (object.name == "ego" ? ", and ego is the vehicle itself" : ""),
               '"' + object.name + '"');
  }
  if (things_->next_instance >= kFirstMastInstance) {
    faults.Add(pointer, "must be one of at most " + std::to_string(kFirstMastInstance - 1) +
                            " objects of a run, those that were removed included");
  }
  auto path = DraftPath({line_->world, network}, object, pointer, from_ns, faults);
  const RailSurfaces& surfaces = *line_->surfaces;
  ObjectModels models(surfaces, line_->labels, line_->materials);
  auto made = DraftObject(object, pointer, {surfaces, line_->labels, models}, faults);
  ObjectPath object_path;
  if (path && made) {
    object_path = DraftObjectPath(
        {line_->alignment, line_->world.terrain.half_width_m, things_->vehicle, from_ns},
        {object, *made, pointer}, std::move(*path), faults);
  }
  faults.errors.ThrowIfAny();

  Things changed = *things_;
  made->moves = object_path.moves();
  GiveBogies(object, *object_path.track, line_->alignment, models, *made);
  GiveLimbs(object, models, *made);
  made->instance = changed.next_instance++;
  auto ways = std::make_shared<std::vector<ObjectWay>>(*changed.ways);
  ways->push_back(WayOf(object, *made->model, std::move(object_path)));
  auto objects = std::make_shared<std::vector<SceneObject>>(*changed.objects);
  objects->push_back(std::move(*made));
  changed.ways = std::move(ways);
  changed.objects = std::move(objects);
  return std::shared_ptr<const RailWorld>(
      new RailWorld(line_, std::make_shared<const Things>(std::move(changed))));
}

std::shared_ptr<const RailWorld> RailWorld::WithoutObject(const std::string& name) const {
  const auto found = std::find_if(
      objects().begin(), objects().end(),
      [&](const SceneObject& object) { return !object.is_ego && object.name == name; });
  if (found == objects().end()) {
    throw InputError({{"/name", "must be the name of an object that is there", Quoted(name)}});
  }
  const auto index = found - objects().begin();
  const ObjectWay& way = things_->ways->at(static_cast<std::size_t>(index));
  if (way.boom) {
    throw InputError({{"/name", "must not be a barrier of a level crossing", Quoted(name)}});
  }
  if (way.is_in_train) {
    throw InputError({{"/name", "must not be a vehicle of a train", Quoted(name)}});
  }
  Things changed = *things_;
  auto ways = std::make_shared<std::vector<ObjectWay>>(*changed.ways);
  ways->erase(ways->begin() + index);
  auto objects = std::make_shared<std::vector<SceneObject>>(*changed.objects);
  objects->erase(objects->begin() + index);
  changed.ways = std::move(ways);
  changed.objects = std::move(objects);
  return std::shared_ptr<const RailWorld>(
      new RailWorld(line_, std::make_shared<const Things>(std::move(changed))));
}

const Alignment& RailWorld::alignment() const {
  return line_->alignment;
}

const TrackSpec& RailWorld::vehicle_track() const {
  return *FindTrack(line_->world, vehicle_route().names.front());
}

const Network& RailWorld::network() const {
  return line_->network;
}

const std::vector<TrackSpec>& RailWorld::tracks() const {
  return line_->world.tracks;
}

const Route& RailWorld::vehicle_route() const {
  return things_->vehicle.route();
}

const TrackCourse& RailWorld::vehicle_course() const {
  return things_->vehicle.course();
}

bool RailWorld::has_changed_vehicle_speed() const {
  return things_->has_changed_vehicle_speed;
}

double RailWorld::VehicleSpeed_mps(std::int64_t time_ns) const {
  return things_->vehicle.SpeedAt_mps(time_ns);
}

double RailWorld::VehicleChainage_m(std::int64_t time_ns) const {
  return things_->vehicle.ChainageAt(time_ns);
}

const TrackSpec& RailWorld::object_track(std::size_t object) const {
  return *FindTrack(line_->world, object_route(object).names.front());
}

const Route& RailWorld::object_route(std::size_t object) const {
  return things_->PathOf(object).route();
}

const TrackCourse& RailWorld::object_course(std::size_t object) const {
  return things_->PathOf(object).course();
}

double RailWorld::ObjectChainage_m(std::size_t object, std::int64_t time_ns) const {
  // That of an object which walks is where its path begins: it does not keep to its track.
  return things_->PathOf(object).ChainageAt(time_ns);
}

VehicleTravel RailWorld::VehicleTravelAt(std::int64_t time_ns) const {
  const SpeedProfile::State now = things_->vehicle.StateAt(time_ns);
  return {now.s_m,           now.speed_mps,      now.acceleration_mps2,
          now.speeding_up_m, now.slowing_down_m, things_->vehicle.reverse()};
}

RigidMotion RailWorld::VehicleMotion(std::int64_t time_ns) const {
  return MotionOnTrack(things_->vehicle, time_ns, [&](double s_m, double v_mps) {
    return line_->WorldFromVehicle(things_->vehicle, s_m, v_mps);
  });
}

Transform RailWorld::WorldFromVehicle(std::int64_t time_ns) const {
  const SpeedProfile::State now = things_->vehicle.StateAt(time_ns);
  return line_->WorldFromVehicle(things_->vehicle, now.s_m, now.speed_mps);
}

int RailWorld::HomeChunk(std::int64_t time_ns) const {
  return line_->grid.ChunkAt(things_->vehicle.ChainageAt(time_ns));
}

std::vector<Transform> RailWorld::VehiclePosesIn(int home_chunk) const {
  const double begin_s_m = line_->grid.BeginOf(home_chunk);
  const double length_m = line_->grid.EndOf(home_chunk) - begin_s_m;
  const int num_steps = std::max(1, static_cast<int>(std::ceil(length_m)));
  std::vector<Transform> poses;
  for (int i = 0; i <= num_steps; ++i) {
    poses.push_back(
        things_->vehicle.WorldFromObjectAt(line_->alignment, begin_s_m + length_m * i / num_steps));
  }
  return poses;
}

std::vector<int> RailWorld::ChunksInReach(int home_chunk, double range_m) const {
  constexpr int kNumSteps = 10;
  double aside_m = 0.0;
  for (int i = 0; i <= kNumSteps; ++i) {
    const double s_m = std::lerp(line_->grid.BeginOf(home_chunk), line_->grid.EndOf(home_chunk),
                                 1.0 * i / kNumSteps);
    aside_m = std::max(aside_m, std::abs(things_->vehicle.course().OffsetAt(s_m).d_m));
  }
  double overhang_m =
      std::max(kOverhang_m, line_->surveyed.half_width_m - line_->world.terrain.half_width_m);
  for (const StructureSpec& structure : line_->world.structures) {
    overhang_m = std::max(overhang_m, OverhangOf_m(structure));
  }
  return line_->grid.WithinReach(home_chunk, range_m + aside_m + overhang_m);
}

Transform RailWorld::WorldFromChunk(int chunk) const {
  return line_->grid.WorldFromChunk(chunk);
}

Chunk RailWorld::BuildChunk(int chunk) const {
  return line_->Build(line_->ContextOf(chunk, line_->grid.WorldFromChunk(chunk).inverse()));
}

Chunk RailWorld::BuildCoarserChunk(int chunk, std::size_t level) const {
  ChunkContext context = line_->ContextOf(chunk, line_->grid.WorldFromChunk(chunk).inverse());
  context.level = level;
  return line_->Build(context);
}

std::vector<CoarserSurfaces> RailWorld::CoarserSurfacesOf(int chunk) const {
  if (line_->survey) return {};
  return CoarserSurfacesBetween({line_->grid.BeginOf(chunk), line_->grid.EndOf(chunk)},
                                line_->alignment, line_->land.width(),
                                line_->grid.WorldFromChunk(chunk).inverse());
}

const std::vector<SceneObject>& RailWorld::objects() const {
  return *things_->objects;
}

Transform RailWorld::WorldFromObject(std::size_t object, std::int64_t time_ns) const {
  const ObjectWay& way = things_->ways->at(object);
  if (way.boom) return way.boom->WorldFromBoom(time_ns);
  if (!way.path) return WorldFromVehicle(time_ns);
  ObjectStance stance = StanceOf(way, things_->PathOf(object), line_->alignment, time_ns);
  Transform& world_from_object = stance.world_from_object;
  if (!way.ground_area_m) return world_from_object;
  const ChunkContext context =
      line_->ContextOf(line_->grid.ChunkAt(stance.s_m), Transform::Identity());
  if (way.follow != Follow::kGround) {
    world_from_object.translation().z() = StandingHeight_m(context, stance.place);
    return world_from_object;
  }
  const SlopeBelow slope = SlopeBelowObject(context, stance.place);
  world_from_object.translation().z() = slope.height_m;
  return world_from_object * RotationBetween(Vector3::UnitZ(), slope.up);
}

std::vector<Transform> RailWorld::WorldFromPieces(std::size_t object, std::int64_t time_ns) const {
  const ObjectWay& way = things_->ways->at(object);
  if (way.walker) {
    const Transform world_from_object = WorldFromObject(object, time_ns);
    std::vector<Transform> limbs = LimbsOf(way, time_ns);
    for (Transform& limb : limbs) limb = world_from_object * limb;
    return limbs;
  }
  const TrackPath& path = things_->PathOf(object);
  if (objects()[object].pieces.empty() || !(path.pose().pivot_distance_m > 0.0)) {
    return World::WorldFromPieces(object, time_ns);
  }
  const auto pieces = path.WorldFromVehicleAt(line_->alignment, path.ChainageAt(time_ns));
  std::vector<Transform> world_from_pieces(pieces.begin(), pieces.end());
  if (!things_->ways->at(object).path) world_from_pieces.front() = WorldFromVehicle(time_ns);
  return world_from_pieces;
}

}  // namespace railcast
