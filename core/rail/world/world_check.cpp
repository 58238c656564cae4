#include <algorithm>
#include <cmath>
#include <set>

#include "core/base/text.h"
#include "core/rail/catenary/catenary.h"
#include "core/rail/network/turnout_place.h"
#include "core/rail/objects/mesh_object.h"
#include "core/rail/structures/structures.h"
#include "core/rail/traffic/object_draft.h"
#include "core/rail/traffic/object_way.h"
#include "core/rail/traffic/trains.h"
#include "core/rail/world/world_draft.h"

namespace railcast {
namespace {

std::string Item(const char* list, std::size_t index) {
  return list + std::to_string(index);
}

constexpr const char* kHalfWidth = "/world/terrain/half_width_m";

void CheckTurnoutsFitGauge(const WorldSpec& world, std::size_t index, WorldFaults& faults) {
  const TrackSpec& track = world.tracks[index];
  for (const auto& [key, turnout] : {std::pair("/begin", &track.begin), {"/end", &track.end}}) {
    if (!*turnout) continue;
    CheckFitsGauge(world,
                   {Item("/world/tracks/", index) + key, "must be absent: there are turnouts",
                    Quoted(std::string(NameOf((*turnout)->turnout)))},
                   faults);
  }
}

void CheckDiamondsFitGauge(const WorldSpec& world, WorldFaults& faults) {
  for (std::size_t i = 0; i < world.diamond_crossings.size(); ++i) {
    CheckFitsGauge(
        world, {Item("/world/diamond_crossings/", i), "must be absent: there are crossings", "one"},
        faults);
  }
}

void CheckTrack(const WorldSpec& world,
                std::size_t index,
                const LineMeasures& line,
                WorldFaults& faults) {
  const TrackSpec& track = world.tracks[index];
  const std::string place = Item("/world/tracks/", index);
  if (faults.AreKnown({place + "/name"}) && FindTrack(world, track.name) != &track) {
    faults.Add(place + "/name", "must be unique", Quoted(track.name));
  }
  const double offset_m = track.offset_m.value_or(0.0);
  if (IsParallel(track) && faults.AreKnown({place + "/offset_m", kHalfWidth}) &&
      !(std::abs(offset_m) < world.terrain.half_width_m)) {
    faults.Add(place + "/offset_m",
               "must lie within the ground's half width of " +
                   NumberText(world.terrain.half_width_m) + " m",
               NumberText(offset_m));
  }
  CheckTurnoutsFitGauge(world, index, faults);
  if (!faults.AreKnown({place + "/start_s_m", place + "/end_s_m"})) return;
  if (!(track.start_s_m >= 0.0 && track.start_s_m < line.length_m)) {
    faults.Add(
        place + "/start_s_m",
        "must be >= 0 and less than the line's length of " + NumberText(line.length_m) + " m",
        NumberText(track.start_s_m));
  }
  if (track.end_s_m && !(*track.end_s_m > track.start_s_m && *track.end_s_m <= line.length_m)) {
    faults.Add(place + "/end_s_m",
               "must be greater than start_s_m and at most the line's length of " +
                   NumberText(line.length_m) + " m",
               NumberText(*track.end_s_m));
  }
}

// Checks the distance of a track that is parallel to the alignment from those before it in the list
// that are, too. CheckNetwork() checks all others.
void CheckDistance(const WorldSpec& world,
                   std::size_t index,
                   const LineMeasures& line,
                   WorldFaults& faults) {
  const TrackSpec& track = world.tracks[index];
  const std::string place = Item("/world/tracks/", index);
  for (std::size_t i = 0; i < index; ++i) {
    const TrackSpec& other = world.tracks[i];
    if (!IsParallel(track) || !IsParallel(other)) continue;
    if (!faults.AreKnown({place, Item("/world/tracks/", i)})) continue;
    const double begin_s_m = std::max(track.start_s_m, other.start_s_m);
    const double end_s_m =
        std::min(track.end_s_m.value_or(line.length_m), other.end_s_m.value_or(line.length_m));
    if (!(begin_s_m < end_s_m)) continue;
    const double offset_m = track.offset_m.value_or(0.0);
    const double other_m = other.offset_m.value_or(0.0);
    if (std::abs(offset_m - other_m) >= kLeastTrackDistance_m) continue;
    faults.Add(place + "/offset_m",
               "must be at least " + NumberText(kLeastTrackDistance_m) + " m from track " +
                   Quoted(other.name) + " at " + NumberText(other_m) + " m, beside which it runs " +
                   StretchText(begin_s_m, end_s_m),
               NumberText(offset_m));
  }
}

void CheckNames(const WorldSpec& world, const VehicleSpec& vehicle, WorldFaults& faults) {
  // Instance ids from kFirstMastInstance on are used for masts, and one id for the vehicle itself
  // and each moving boom.
  std::set<std::string> own_names{"ego"};
  for (std::size_t i = 0; i < vehicle.consist.size(); ++i) {
    own_names.insert(NameOfEgoVehicle(vehicle, i));
  }
  std::set<std::string> names = own_names;
  for (const StructureSpec& structure : world.structures) {
    const auto* crossing = std::get_if<LevelCrossingSpec>(&structure);
    if (crossing == nullptr || crossing->barrier_angles_deg.empty()) continue;
    for (const double side : {-1.0, 1.0}) names.insert(BoomName(crossing->name, side));
  }
  const std::size_t num_booms = names.size() - own_names.size();
  const std::size_t num_vehicles = NumVehicles(world.trains) + own_names.size() - 1;
  constexpr std::size_t kMostWithBooms = kFirstMastInstance - 2;
  if (world.objects.size() + num_booms + num_vehicles > kMostWithBooms) {
    std::string with_booms =
        " together with the " + NumberText(num_booms) + " booms of moving barriers";
    if (num_vehicles > 0) {
      with_booms += " and the " + NumberText(num_vehicles) + " vehicles of trains";
    }
    faults.errors.Add({"/world/objects",
                       "must be at most " + NumberText(kMostWithBooms) +
                           (num_booms + num_vehicles > 0 ? with_booms : ""),
                       NumberText(world.objects.size())});
  }
  for (std::size_t i = 0; i < world.objects.size(); ++i) {
    const std::string& name = world.objects[i].name;
    const std::string pointer = Item("/world/objects/", i) + "/name";
    if (!faults.AreKnown({pointer}) || names.insert(name).second) continue;
    faults.Add(
        pointer,
        std::string("must be unique") + (name == "ego" ? ", and ego is the vehicle itself" : ""),
        Quoted(name));
  }
  CheckNamesOfTrains(world, names, faults);
}

void CheckEgoBoxes(const VehicleSpec& vehicle, WorldFaults& faults) {
  for (std::size_t i = 0; i < vehicle.ego_boxes_m.size(); ++i) {
    const std::array<double, 6>& box = vehicle.ego_boxes_m[i];
    const std::string pointer = Item("/vehicle/ego_boxes_m/", i) + "/";
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::string least = pointer + std::to_string(axis);
      const std::string most = pointer + std::to_string(axis + 3);
      if (!faults.AreKnown({least, most}) || box[axis] < box[axis + 3]) continue;
      faults.Add(most, "must be greater than the box's least of " + NumberText(box[axis]),
                 NumberText(box[axis + 3]));
    }
  }
}

/// The greatest distance between the pivots of what runs on a track; absent if unknown. A body as
/// long as the radius spans 60 degrees of the arc, within which the steps that find its second
/// pivot (motion/track_path.cpp) converge.
std::optional<double> MostPivotDistance_m(const WorldSpec& world,
                                          const std::string& track_name,
                                          const LineMeasures& line,
                                          const WorldFaults& faults) {
  const TrackSpec* track = FindTrack(world, track_name);
  if (track == nullptr || !IsParallel(*track) ||
      !faults.AreKnown({TrackPointer(*track, world) + "/offset_m"})) {
    return std::nullopt;
  }
  return line.tightest_radius_m - std::abs(track->offset_m.value_or(0.0));
}

/// A rail vehicle that is given by its type.
struct TypedVehicle {
  ObjectType type{};
  std::string pointer;  ///< Pointer of its type.
};

void CheckPivotsOf(const TypedVehicle& vehicle, std::optional<double> most_m, WorldFaults& faults) {
  if (!most_m || !faults.AreKnown({vehicle.pointer}) || !IsRailVehicle(vehicle.type)) return;
  const double distance_m = MeasuresOf(vehicle.type).pivot_distance_m;
  if (distance_m <= *most_m) return;
  faults.Add(vehicle.pointer, "must have pivots at most its track's tightest radius of " +
                                  NumberText(*most_m) + " m apart (got " +
                                  Quoted(std::string(NameOf(vehicle.type))) + " with " +
                                  NumberText(distance_m) + " m)");
}

void CheckPivots(const WorldSpec& world,
                 const VehicleSpec& vehicle,
                 const LineMeasures& line,
                 WorldFaults& faults) {
  const auto most_on = [&](const std::string& track, const std::vector<std::string>& route) {
    return route.empty() ? MostPivotDistance_m(world, track, line, faults) : std::nullopt;
  };
  for (std::size_t i = 0; i < world.objects.size(); ++i) {
    const ObjectSpec& object = world.objects[i];
    if (!RestsOnPivots(object)) continue;
    CheckPivotsOf({object.type, Item("/world/objects/", i) + "/type"},
                  most_on(object.track, object.route), faults);
  }
  for (std::size_t i = 0; i < world.trains.size(); ++i) {
    const TrainSpec& train = world.trains[i];
    const std::optional<double> most_m = most_on(train.track, train.route);
    for (std::size_t k = 0; k < train.vehicles.size(); ++k) {
      const std::string pointer = Item("/world/trains/", i) + Item("/vehicles/", k) + "/type";
      CheckPivotsOf({train.vehicles[k].type, pointer}, most_m, faults);
    }
  }
  const std::optional<double> most_m = most_on(vehicle.track, vehicle.route);
  for (std::size_t i = 0; i < vehicle.consist.size(); ++i) {
    CheckPivotsOf({vehicle.consist[i].type, Item("/vehicle/consist/", i) + "/type"}, most_m,
                  faults);
  }
  if (!most_m || !vehicle.consist.empty() || vehicle.pivot_distance_m <= *most_m) return;
  faults.Add("/vehicle/pivot_distance_m",
             "must be at most its track's tightest radius of " + NumberText(*most_m) + " m",
             NumberText(vehicle.pivot_distance_m));
}

void CheckHalfWidth(const WorldSpec& world, WorldFaults& faults) {
  const double half_width_m = world.terrain.half_width_m;
  if (!faults.AreKnown({kHalfWidth}) || half_width_m > 0.0) return;
  faults.Add(kHalfWidth, "must be > 0", NumberText(half_width_m));
}

}  // namespace

void CheckObject(const WorldSpec& world,
                 const ObjectSpec& object,
                 const std::string& pointer,
                 const LineOfTracks& line,
                 WorldFaults& faults) {
  if (IsRailVehicle(object.type)) {
    CheckWheelsFit(world, object.type, pointer + "/type", faults);
  }
  if (object.frame && !world.recording) {
    faults.Add(pointer + "/frame", "must be left out: only recordings have frames",
               NumberText(*object.frame));
  }
  if (!object.route.empty()) return;
  const TrackPlace place{pointer + "/track", pointer + "/s_m", object.track, object.s_m};
  const TrackSpec* track = CheckTrackPlace(world, place, line, faults);
  if (track == nullptr) return;
  double offset_m = track->offset_m.value_or(0.0);
  if (!IsParallel(*track)) {
    const auto& course = line.courses[static_cast<std::size_t>(track - world.tracks.data())];
    if (!course || !faults.AreKnown({pointer + "/s_m"})) return;
    offset_m = course->OffsetWithin_m(object.s_m);
  }
  const double from_axis_m = offset_m + object.d_m;
  if (faults.AreKnown({pointer + "/d_m", TrackPointer(*track, world) + "/offset_m", kHalfWidth}) &&
      !(std::abs(from_axis_m) <= world.terrain.half_width_m)) {
    faults.Add(pointer + "/d_m", "must put it within the ground's half width of " +
                                     NumberText(world.terrain.half_width_m) +
                                     " m (got track offset " + NumberText(offset_m) + " + d_m " +
                                     NumberText(object.d_m) + " = " + NumberText(from_axis_m) +
                                     ")");
  }
}

void CheckWorld(const WorldSpec& world,
                const VehicleSpec& vehicle,
                const LineOfTracks& line,
                WorldFaults& faults) {
  CheckHalfWidth(world, faults);
  if (world.recording && faults.AreKnown({"/world/alignment"})) {
    faults.Add("/world/recording",
               "must be left out: this is a plan for railcast-generate insert, not a scenario");
  }
  if (world.tracks.empty()) {
    faults.Add("/world/tracks", "must have at least one track", "none");
    return;  // Without a track, every check below would report another fault.
  }
  for (std::size_t i = 0; i < world.tracks.size(); ++i) CheckTrack(world, i, line.measures, faults);
  CheckDiamondsFitGauge(world, faults);
  for (std::size_t i = 1; i < world.tracks.size(); ++i)
    CheckDistance(world, i, line.measures, faults);
  for (std::size_t i = 0; i < world.objects.size(); ++i) {
    CheckObject(world, world.objects[i], Item("/world/objects/", i), line, faults);
  }
  CheckTrains(world, vehicle, line, faults);
  CheckNames(world, vehicle, faults);
  CheckStructures(world, line, faults);
  if (vehicle.route.empty()) {
    CheckTrackPlace(world,
                    {"/vehicle/track", "/vehicle/start_s_m", vehicle.track, vehicle.start_s_m},
                    line, faults);
  }
  CheckEgoBoxes(vehicle, faults);
  if (vehicle.ride && vehicle.consist.empty() && !(vehicle.pivot_distance_m > 0.0) &&
      faults.AreKnown({"/vehicle/ride", "/vehicle/pivot_distance_m"})) {
    faults.Add("/vehicle/ride", "must be absent: without pivots there is no body on springs",
               "pivot_distance_m " + NumberText(vehicle.pivot_distance_m));
  }
  CheckPivots(world, vehicle, line.measures, faults);
}

}  // namespace railcast
