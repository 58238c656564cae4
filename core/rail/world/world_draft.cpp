#include "core/rail/world/world_draft.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <tuple>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/rail/clearance/tunnel_shape.h"
#include "core/rail/landform/landform.h"
#include "core/rail/motion/speed_profile.h"
#include "core/rail/network/network_draft.h"
#include "core/rail/network/route.h"
#include "core/rail/objects/mesh_object.h"
#include "core/rail/traffic/object_draft.h"
#include "core/rail/traffic/object_way.h"

namespace railcast {
namespace {

// Makes the line if its course is known, leaving out all other values that are unknown.
std::optional<Alignment> DraftAlignment(const WorldSpec& world, WorldFaults& faults) {
  const std::string place = "/world/alignment";
  if (!faults.AreKnown({place + "/course"}) || world.recording) return std::nullopt;
  AlignmentSpec known = world.alignment;
  if (!faults.AreKnown({place + "/gradients_permil"})) known.gradients_permil.clear();
  if (!faults.AreKnown({place + "/speed_limits_kmph"})) known.speed_limits_kmph.clear();
  if (!faults.AreKnown({place + "/cants_mm"})) known.cants_mm.clear();
  if (auto alignment = Attempt(place, faults.errors, [&] { return Alignment(known); })) {
    return alignment;
  }
  // Whatever else is wrong with the line, its course alone gives its length and tightest radius.
  AlignmentSpec bare;
  bare.course = known.course;
  ErrorList known_faults;
  return Attempt("", known_faults, [&] { return Alignment(bare); });
}

std::optional<CatenaryPlan> DraftCatenary(const WorldSpec& world,
                                          const std::optional<Alignment>& alignment,
                                          const NetworkDraft& network,
                                          WorldFaults& faults) {
  if (!faults.AreKnown({"/world/catenary"})) return std::nullopt;
  for (std::size_t i = 0; i < world.tracks.size(); ++i) {
    const std::string place = TrackPointer(i);
    if (!faults.AreKnown({place + "/electrified"})) return std::nullopt;
  }
  const auto make = [&]() -> std::optional<CatenaryPlan> {
    CheckSystemHeight(world);
    std::vector<TrackCourse> courses;
    for (const auto& course : network.courses) {
      if (course) courses.push_back(*course);
    }
    if (!alignment || courses.size() < world.tracks.size()) return std::nullopt;
    return CatenaryPlan({world, courses}, *alignment);
  };
  return Attempt("/world", faults.errors, make).value_or(std::nullopt);
}

std::optional<StripWidth> DraftStripWidth(const WorldSpec& world,
                                          const std::optional<Alignment>& alignment,
                                          const NetworkDraft& network,
                                          WorldFaults& faults) {
  if (!alignment || !faults.AreKnown({"/world/terrain/half_width_m"})) return std::nullopt;
  StripWidth width(*alignment, world.terrain.half_width_m);
  for (std::size_t i = 0; width.narrows() && i < world.tracks.size(); ++i) {
    const std::string place = TrackPointer(i) + "/offset_m";
    const std::optional<TrackCourse>& course = network.courses[i];
    if (!course || !faults.AreKnown({place})) continue;
    double room_m = std::numeric_limits<double>::infinity();
    double worst_s_m = 0.0;
    const auto num_steps = static_cast<int>(
        std::ceil((course->end_s_m() - course->begin_s_m()) / StripWidth::kStep_m));
    for (int k = 0; k <= num_steps; ++k) {
      const double s_m =
          std::lerp(course->begin_s_m(), course->end_s_m(), 1.0 * k / std::max(1, num_steps));
      const double here_m = width.RoomAt_m(s_m, course->OffsetWithin_m(s_m));
      if (here_m < room_m) std::tie(room_m, worst_s_m) = std::pair(here_m, s_m);
    }
    if (room_m > kFormationEdge_m) continue;
    const double offset_m = course->OffsetWithin_m(worst_s_m);
    faults.Add(place,
               "must leave " + NumberText(kFormationEdge_m) +
                   " m to the edge of the ground, which narrows to " +
                   ShortText(room_m + std::abs(offset_m)) + " m in a curve",
               NumberText(offset_m));
  }
  return width;
}

std::optional<DemHeights> DraftElevation(const WorldSpec& world,
                                         const WorldDraft& draft,
                                         WorldFaults& faults) {
  const std::optional<ElevationSpec>& spec = world.terrain.elevation;
  const std::string place = "/world/terrain/elevation";
  if (!spec || !faults.AreKnown({place})) return std::nullopt;
  auto elevation = Attempt(place + "/file: ", faults.errors, [&] { return DemHeights(*spec); });
  if (!elevation || !draft.alignment || !draft.strip_width) return elevation;
  if (const auto fault = CoverageFault(*elevation, *draft.alignment, *draft.strip_width)) {
    faults.Add(place + "/file", *fault);
  }
  return elevation;
}

std::shared_ptr<const SurveyedScene> DraftSurvey(const WorldSource& source, WorldFaults& faults) {
  const std::string place = "/world/survey";
  if (!source.world.survey || !faults.AreKnown({place, "/labels", "/materials"})) return nullptr;
  return Attempt(place + ": ", faults.errors,
                 [&, open = WorldExtras::Get().open_survey] {
                   if (open == nullptr) throw LacksExtra(ShownPath(*source.world.survey), "survey");
                   return open(*source.world.survey, source.labels, source.materials);
                 })
      .value_or(nullptr);
}

// Checks that the tables have what the models of the sensor's own train need.
void CheckNamesOfOwnTrain(const WorldSource& source, WorldFaults& faults) {
  for (std::size_t i = 0; i < source.vehicle.consist.size(); ++i) {
    const std::string pointer = "/vehicle/consist/" + std::to_string(i);
    if (!faults.AreKnown({pointer + "/type", "/labels", "/materials"})) continue;
    Attempt(pointer + ": ", faults.errors, [&] {
      CheckNamesOfModel(source.vehicle.consist[i].type, source.labels, source.materials);
      return true;
    });
  }
}

void DraftObjects(const TracksOfWorld& tracks,
                  const ObjectTables& tables,
                  WorldFaults& faults,
                  WorldDraft& draft) {
  const WorldSpec& world = tracks.world;
  ObjectModels& models = tables.models;
  for (std::size_t i = 0; i < world.objects.size(); ++i) {
    const std::string pointer = "/world/objects/" + std::to_string(i);
    auto path = DraftPath(tracks, world.objects[i], pointer, 0, faults);
    auto object = DraftObject(world.objects[i], pointer, tables, faults);
    if (!path || !object) continue;
    if (draft.alignment) GiveBogies(world.objects[i], *path, *draft.alignment, models, *object);
    ObjectPath object_path{std::move(path), {}};
    if (draft.alignment && draft.vehicle_path) {
      object_path = DraftObjectPath(
          {*draft.alignment, world.terrain.half_width_m, *draft.vehicle_path, 0},
          {world.objects[i], *object, pointer}, std::move(*object_path.track), faults);
    }
    object->moves = object_path.moves();
    GiveLimbs(world.objects[i], models, *object);
    draft.object_paths.push_back(std::move(object_path));
    draft.objects.push_back(std::move(*object));
  }
  for (std::size_t i = 0; draft.alignment && i < world.trains.size(); ++i) {
    for (TrainVehicle& made : DraftTrain(world.trains[i], "/world/trains/" + std::to_string(i),
                                         {tracks, *draft.alignment, tables}, faults)) {
      draft.object_paths.push_back({std::move(made.path), {}});
      draft.objects.push_back(std::move(made.object));
    }
  }
}

RailSurfaces SurfacesOf(const WorldSource& source, const NetworkDraft& network) {
  RailSurfaces surfaces(source.labels, source.materials);
  if (source.world.vegetation.bushes_per_hectare > 0.0) {
    surfaces.AddBushSurfaces(source.labels, source.materials);
  }
  if (!source.world.structures.empty()) {
    surfaces.AddStructureSurfaces(source.labels, source.materials);
  }
  if (!network.turnouts.empty() || !network.diamonds.empty()) {
    surfaces.AddTurnoutSurfaces(source.labels, source.materials);
  }
  return surfaces;
}

}  // namespace

WorldDraft DraftWorld(const WorldSource& source, WorldFaults& faults) {
  WorldDraft draft;
  draft.world = source.world;
  if (faults.AreKnown({"/world/yards"})) {
    const std::size_t num_faults = faults.errors.size();
    CheckYards(source.world, faults.errors);
    if (faults.errors.size() == num_faults) draft.world = WithTracksOfYards(source.world);
  }
  const WorldSpec& world = draft.world;
  const std::size_t num_faults_before = faults.errors.size();
  draft.alignment = DraftAlignment(world, faults);
  const bool is_line_known = faults.errors.size() == num_faults_before &&
                             faults.AreKnown({"/world/alignment"}) && !world.recording;
  // If the line is unknown, no chainage can be beyond it.
  constexpr double kEndless_m = std::numeric_limits<double>::infinity();
  const LineMeasures line = draft.alignment ? LineMeasures{draft.alignment->length_m(),
                                                           draft.alignment->tightest_radius_m()}
                                            : LineMeasures{kEndless_m, kEndless_m};
  draft.network = DraftNetwork(world, line.length_m, faults);
  for (std::size_t i = 0; i < world.objects.size(); ++i) {
    PlaceFromMap({world, draft.network, is_line_known ? &*draft.alignment : nullptr},
                 "/world/objects/" + std::to_string(i), draft.world.objects[i], faults);
  }
  CheckWorld(world, source.vehicle, {line, draft.network.courses}, faults);
  CheckNetwork(world, draft.network, draft.alignment, faults);
  if (faults.AreKnown({"/labels", "/materials"})) {
    draft.surfaces = Attempt("", faults.errors, [&] { return SurfacesOf(source, draft.network); });
    if (!source.vehicle.ego_boxes_m.empty() || !source.vehicle.consist.empty()) {
      Attempt("", faults.errors, [&] { return source.labels.Id("ego"); });
    }
  }
  CheckNamesOfOwnTrain(source, faults);
  const TracksOfWorld tracks{world, draft.network};
  draft.vehicle_path = DraftVehiclePath(source.vehicle, tracks, faults);
  if (draft.vehicle_path && draft.alignment) {
    CheckEgoTrain(source.vehicle, tracks, *draft.alignment, *draft.vehicle_path, faults);
  }
  if (draft.vehicle_path) SetPositions(draft.vehicle_path->route(), draft.network);
  const RailSurfaces surfaces = draft.surfaces.value_or(RailSurfaces());
  ObjectModels models(surfaces, source.labels, source.materials);
  const ObjectTables tables{surfaces, source.labels, models};
  DraftObjects(tracks, tables, faults, draft);
  draft.catenary_plan = DraftCatenary(world, draft.alignment, draft.network, faults);
  draft.strip_width = DraftStripWidth(world, draft.alignment, draft.network, faults);
  draft.elevation = DraftElevation(world, draft, faults);
  draft.survey = DraftSurvey(source, faults);
  ErrorList errors;
  for (const Fault& fault : faults.errors.faults()) errors.Add(FaultOfYard(source.world, fault));
  faults.errors = std::move(errors);
  return draft;
}

std::vector<TrackPath> BoomPaths(const WorldDraft& draft) {
  std::vector<TrackPath> paths;
  for (const StructureSpec& structure : draft.world.structures) {
    const auto* crossing = std::get_if<LevelCrossingSpec>(&structure);
    if (crossing == nullptr || crossing->barrier_angles_deg.empty()) continue;
    WorldFaults faults;
    const auto route =
        MakeRoute(draft.world, draft.network, {"", {crossing->track}, false}, faults);
    Check(route.has_value(), "a level crossing's track exists");
    paths.insert(paths.end(), 2,
                 TrackPath(*route, TrackPose{.is_upright = true},
                           SpeedProfile(MotionSpec{}, crossing->s_m)));
  }
  return paths;
}

}  // namespace railcast
