#include "railcast/rail_world.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/rail/catenary/catenary.h"
#include "core/rail/chunk/chunk_context.h"
#include "core/rail/landform/landform.h"
#include "core/rail/motion/ride.h"
#include "core/rail/motion/track_path.h"
#include "core/rail/objects/mesh_object.h"
#include "core/rail/structures/standing_height.h"
#include "core/rail/structures/structures.h"
#include "core/rail/traffic/object_draft.h"
#include "core/rail/traffic/object_way.h"
#include "core/rail/traffic/trains.h"
#include "core/rail/world/rail_world_parts.h"
#include "core/rail/world/world_draft.h"
#include "core/scene/rotation_between.h"

namespace railcast {
namespace {

// Maximum extent of tree crowns and cantilevers beyond the ground of their chunk.
constexpr double kOverhang_m = 8.0;

}  // namespace

SharedLines::SharedLines() : parts_(std::make_unique<Parts>()) {}

SharedLines::~SharedLines() = default;

RailWorld::RailWorld(const RailWorld& like, std::shared_ptr<const Things> things)
    : line_(like.line_), setting_(like.setting_), things_(std::move(things)) {}

// NOLINTNEXTLINE(readability-function-size): makes one member after the other
RailWorld::RailWorld(const WorldSpec& world,
                     const VehicleSpec& vehicle,
                     const LabelTable& labels,
                     const MaterialLibrary& materials,
                     std::uint64_t seed,
                     SharedLines* shared) {
  WorldFaults faults;
  WorldDraft draft = DraftWorld({world, vehicle, labels, materials}, faults);
  faults.errors.ThrowIfAny();

  const RailSurfaces& surfaces = *draft.surfaces;
  const Alignment& alignment = *draft.alignment;
  std::vector<TrackPath> boom_paths = BoomPaths(draft);
  const LineKey key = KeyOf(draft, seed);
  // What a survey has depends on more than the key; a file of heights takes much memory, and may
  // change.
  bool is_known = shared != nullptr && draft.survey == nullptr && !draft.elevation;
  const auto lay = [&] {
    is_known = false;
    return LayLine(draft, key);
  };
  line_ = is_known ? shared->parts_->lines.Get(key, lay) : lay();
  const auto grow = [&] { return std::make_shared<const PlantsOnDemand>(surfaces, seed); };
  setting_ = std::make_shared<const Setting>(Setting{
      std::move(draft.world), labels, materials,
      shared == nullptr ? grow() : shared->parts_->plants.Get(PlantsKey{surfaces, seed}, grow),
      RideOf(vehicle, world.seed), is_known});

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
  if (setting_->has_plants()) static_cast<void>(setting_->plants->Get());
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
      new RailWorld(*this, std::make_shared<const Things>(std::move(changed))));
}

std::shared_ptr<const RailWorld> RailWorld::WithObject(const ObjectSpec& given,
                                                       std::int64_t from_ns) const {
  const std::string pointer = "/object";
  WorldFaults faults;
  const std::vector<std::optional<TrackCourse>> courses(line_->network.courses.begin(),
                                                        line_->network.courses.end());
  const NetworkDraft network{courses, line_->network.turnouts};
  ObjectSpec object = given;
  PlaceFromMap({setting_->world, network, &line_->alignment}, pointer, object, faults);
  CheckObject(setting_->world, object, pointer, {line_->Measures(), courses}, faults);
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
  auto path = DraftPath({setting_->world, network}, object, pointer, from_ns, faults);
  const RailSurfaces& surfaces = line_->surfaces;
  ObjectModels models(surfaces, setting_->labels, setting_->materials);
  auto made = DraftObject(object, pointer, {surfaces, setting_->labels, models}, faults);
  ObjectPath object_path;
  if (path && made) {
    object_path = DraftObjectPath(
        {line_->alignment, setting_->world.terrain.half_width_m, things_->vehicle, from_ns},
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
      new RailWorld(*this, std::make_shared<const Things>(std::move(changed))));
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
      new RailWorld(*this, std::make_shared<const Things>(std::move(changed))));
}

const Alignment& RailWorld::alignment() const {
  return line_->alignment;
}

const TrackSpec& RailWorld::vehicle_track() const {
  return *FindTrack(setting_->world, vehicle_route().names.front());
}

const Network& RailWorld::network() const {
  return line_->network;
}

const std::vector<TrackSpec>& RailWorld::tracks() const {
  return setting_->world.tracks;
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
  return *FindTrack(setting_->world, object_route(object).names.front());
}

const Route& RailWorld::object_route(std::size_t object) const {
  return things_->PathOf(object).route();
}

const TrackCourse& RailWorld::object_course(std::size_t object) const {
  return things_->PathOf(object).course();
}

double RailWorld::ObjectChainage_m(std::size_t object, std::int64_t time_ns) const {
  // An object that walks has the chainage where its path begins: it does not keep to its track.
  return things_->PathOf(object).ChainageAt(time_ns);
}

VehicleTravel RailWorld::VehicleTravelAt(std::int64_t time_ns) const {
  const SpeedProfile::State now = things_->vehicle.StateAt(time_ns);
  return {now.s_m,           now.speed_mps,      now.acceleration_mps2,
          now.speeding_up_m, now.slowing_down_m, things_->vehicle.reverse()};
}

RigidMotion RailWorld::VehicleMotion(std::int64_t time_ns) const {
  return MotionOnTrack(things_->vehicle, time_ns,
                       [&](double s_m, double speed_mps, double after_s) {
                         return WorldFromVehicleAt(s_m, speed_mps, time_ns, after_s);
                       });
}

Transform RailWorld::WorldFromVehicleAt(double s_m,
                                        double speed_mps,
                                        std::int64_t time_ns,
                                        double after_s) const {
  const TrackPath& path = things_->vehicle;
  Transform world_from_perfect = path.WorldFromObjectAt(line_->alignment, s_m);
  const std::optional<Ride>& ride = setting_->ride;
  if (!ride) return world_from_perfect;
  const double sprung_mps2 = path.SprungAccelerationAt_mps2(Ride::kVertical, time_ns, after_s);
  return world_from_perfect *
         ride->PerfectFromVehicle(ride->At(s_m, speed_mps, path.reverse(), sprung_mps2));
}

Transform RailWorld::WorldFromVehicle(std::int64_t time_ns) const {
  const SpeedProfile::State now = things_->vehicle.StateAt(time_ns);
  return WorldFromVehicleAt(now.s_m, now.speed_mps, time_ns, 0.0);
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
      std::max(kOverhang_m, line_->surveyed.half_width_m - setting_->world.terrain.half_width_m);
  for (const StructureSpec& structure : setting_->world.structures) {
    overhang_m = std::max(overhang_m, OverhangOf_m(structure));
  }
  return line_->grid.WithinReach(home_chunk, range_m + aside_m + overhang_m);
}

Transform RailWorld::WorldFromChunk(int chunk) const {
  return line_->grid.WorldFromChunk(chunk);
}

Chunk RailWorld::BuildChunk(int chunk) const {
  return BuildCoarserChunk(chunk, 0);
}

Chunk RailWorld::BuildCoarserChunk(int chunk, std::size_t level) const {
  Chunk built = BuildBareChunk(chunk, level);
  std::ranges::move(PlantsOf(chunk), std::back_inserter(built.placements));
  return built;
}

std::shared_ptr<const void> RailWorld::bare_line() const {
  return setting_->is_known_line ? line_ : nullptr;
}

Chunk RailWorld::BuildBareChunk(int chunk, std::size_t level) const {
  return line_->Build(chunk, level);
}

std::vector<Placement> RailWorld::PlantsOf(int chunk) const {
  if (!setting_->has_plants()) return {};
  return line_->PlantsOf(chunk, setting_->world, setting_->plants->Get());
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
