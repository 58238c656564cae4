#include "core/rail/traffic/object_draft.h"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/text.h"
#include "core/rail/line/track_course.h"
#include "core/rail/network/route.h"
#include "core/rail/network/turnout_place.h"
#include "core/rail/traffic/object_way.h"
#include "core/rail/traffic/trains.h"

namespace railcast {
namespace {

std::string TrainPointer(std::size_t index) {
  return "/world/trains/" + std::to_string(index);
}

void CheckVehicles(const WorldSpec& world,
                   const std::vector<TrainVehicleSpec>& vehicles,
                   const std::string& pointer,
                   WorldFaults& faults) {
  for (std::size_t i = 0; i < vehicles.size(); ++i) {
    const std::string type = pointer + "/" + std::to_string(i) + "/type";
    if (!faults.AreKnown({type})) continue;
    if (!IsRailVehicle(vehicles[i].type)) {
      faults.Add(type, "must be a vehicle that runs on rails",
                 Quoted(std::string(NameOf(vehicles[i].type))));
      continue;
    }
    CheckWheelsFit(world, vehicles[i].type, type, faults);
  }
}

/// The foremost buffers, as an object that the rest of the train follows.
ObjectSpec FrontOf(const TrainSpec& train) {
  ObjectSpec front;
  front.name = train.name;
  front.type = ObjectType::kBox;
  front.track = train.track;
  front.s_m = train.s_m;
  front.motion = train.motion;
  front.route = train.route;
  return front;
}

/// A train at time 0.
struct StandingTrain {
  const std::vector<TrainVehicleSpec>& vehicles;
  std::string vehicles_pointer;
  std::string place_pointer;  ///< Pointer of the chainage that places it on its track.
  double s_m{};               ///< The chainage that places it.
  std::string way_pointer;    ///< Pointer of its track or route.
  bool runs_back{};
  double front_s_m{};  ///< Chainage of its foremost buffers.

  [[nodiscard]] double RearOn_s_m(const TrackLength& track) const {
    const double length_m = LengthOf_m(vehicles);
    return track.MovedFrom(front_s_m, runs_back ? length_m : -length_m);
  }
};

/// Whether the whole train is on its track.
bool CheckFits(const StandingTrain& train,
               const Route& route,
               const TrackLength& track,
               WorldFaults& faults) {
  if (!faults.AreKnown({train.place_pointer})) return false;
  // A train may end exactly where its track does, whatever the rounding.
  constexpr double kRounding_m = 1e-3;
  const double length_m = LengthOf_m(train.vehicles);
  if (length_m > track.total_m() + kRounding_m) {
    faults.Add(train.vehicles_pointer,
               "must be at most as long together as " + WayText(route) + ", " +
                   MetresText(track.total_m()) + " m",
               MetresText(length_m) + " m");
    return false;
  }
  const double rear_s_m = train.RearOn_s_m(track);
  const auto [least_m, most_m] = std::minmax(train.front_s_m, rear_s_m);
  if (least_m >= route.course.begin_s_m() - kRounding_m &&
      most_m <= route.course.end_s_m() + kRounding_m) {
    return true;
  }
  faults.Add(train.place_pointer,
             "must leave room for the train's " + MetresText(length_m) + " m on " + WayText(route) +
                 ", " + StretchText(route.course.begin_s_m(), route.course.end_s_m()),
             NumberText(train.s_m));
  return false;
}

// Checks the turnouts below the train; those ahead of its place are checked with the path.
void CheckTurnoutsBelow(const StandingTrain& train,
                        const TracksOfWorld& tracks,
                        const Route& route,
                        const TrackLength& track,
                        WorldFaults& faults) {
  const double rear_s_m = train.RearOn_s_m(track);
  const auto [least_m, most_m] = std::minmax(rear_s_m, train.s_m);
  Route below = route;
  std::erase_if(below.passages, [&](const RoutePassage& passage) {
    const double s_m = tracks.network.turnouts[passage.turnout].s_m;
    return !(s_m > least_m && s_m < most_m);
  });
  const RouteSpec spec{.pointer = train.way_pointer,
                       .tracks = {},
                       .runs_back = train.runs_back,
                       .from_s_m = rear_s_m};
  CheckPositions(tracks.world, tracks.network, below, spec, faults);
}

}  // namespace

void CheckTrains(const WorldSpec& world,
                 const VehicleSpec& vehicle,
                 const LineOfTracks& line,
                 WorldFaults& faults) {
  for (std::size_t i = 0; i < world.trains.size(); ++i) {
    const TrainSpec& train = world.trains[i];
    const std::string pointer = TrainPointer(i);
    CheckVehicles(world, train.vehicles, pointer + "/vehicles", faults);
    if (train.vehicles.empty() && faults.AreKnown({pointer + "/vehicles"})) {
      faults.Add(pointer + "/vehicles", "must have at least one vehicle", "none");
    }
    if (!train.route.empty()) continue;
    CheckTrackPlace(world, {pointer + "/track", pointer + "/s_m", train.track, train.s_m}, line,
                    faults);
  }
  CheckVehicles(world, vehicle.consist, "/vehicle/consist", faults);
  if (vehicle.sensor_vehicle > 0 && vehicle.sensor_vehicle >= vehicle.consist.size() &&
      faults.AreKnown({"/vehicle/sensor_vehicle", "/vehicle/consist"})) {
    faults.Add("/vehicle/sensor_vehicle", "must be the index of a vehicle in consist",
               NumberText(vehicle.sensor_vehicle));
  }
}

void CheckNamesOfTrains(const WorldSpec& world, std::set<std::string>& names, WorldFaults& faults) {
  for (std::size_t i = 0; i < world.trains.size(); ++i) {
    const TrainSpec& train = world.trains[i];
    const std::string train_name = TrainPointer(i) + "/name";
    if (faults.AreKnown({train_name}) && !names.insert(train.name).second) {
      faults.Add(train_name, "must be unique", Quoted(train.name));
    }
    for (std::size_t k = 0; k < train.vehicles.size(); ++k) {
      const std::string pointer = TrainPointer(i) + "/vehicles/" + std::to_string(k) + "/name";
      const std::string name = NameOfVehicle(train, k);
      if (!faults.AreKnown({pointer, TrainPointer(i) + "/name"}) || names.insert(name).second) {
        continue;
      }
      faults.Add(pointer, "must be unique", Quoted(name));
    }
  }
}

std::vector<TrainVehicle> DraftTrain(const TrainSpec& train,
                                     const std::string& pointer,
                                     const TrainTables& tables,
                                     WorldFaults& faults) {
  const std::optional<TrackPath> front =
      DraftPath(tables.tracks, FrontOf(train), pointer, 0, faults);
  if (!front || !faults.AreKnown({pointer + "/vehicles"})) return {};
  const auto length = std::make_shared<const TrackLength>(tables.alignment, front->course());
  const bool runs_back = RunsBack(train);
  const StandingTrain standing{.vehicles = train.vehicles,
                               .vehicles_pointer = pointer + "/vehicles",
                               .place_pointer = pointer + "/s_m",
                               .s_m = train.s_m,
                               .way_pointer = pointer + (train.route.empty() ? "/track" : "/route"),
                               .runs_back = runs_back,
                               .front_s_m = train.s_m};
  if (!CheckFits(standing, front->route(), *length, faults)) return {};
  CheckTurnoutsBelow(standing, tables.tracks, front->route(), *length, faults);
  std::vector<TrainVehicle> vehicles;
  for (std::size_t i = 0; i < train.vehicles.size(); ++i) {
    ObjectSpec spec;
    spec.name = NameOfVehicle(train, i);
    spec.type = train.vehicles[i].type;
    auto object =
        DraftObject(spec, pointer + "/vehicles/" + std::to_string(i), tables.objects, faults);
    if (!object) continue;
    TrackPath path = front->Behind(length, MiddleBehindFront_m(train.vehicles, i),
                                   PoseInTrain(train.vehicles[i], runs_back));
    object->moves = path.moves();
    GiveBogies(spec, path, tables.alignment, tables.objects.models, *object);
    vehicles.push_back({std::move(*object), std::move(path)});
  }
  return vehicles;
}

void CheckEgoTrain(const VehicleSpec& vehicle,
                   const TracksOfWorld& tracks,
                   const Alignment& alignment,
                   const TrackPath& path,
                   WorldFaults& faults) {
  if (vehicle.consist.empty() ||
      !faults.AreKnown({"/vehicle/consist", "/vehicle/sensor_vehicle"})) {
    return;
  }
  const TrackLength length(alignment, path.course());
  const bool runs_back = vehicle.motion.reverse;
  const double ahead_m = OriginBehindFront_m(vehicle);
  const StandingTrain standing{
      .vehicles = vehicle.consist,
      .vehicles_pointer = "/vehicle/consist",
      .place_pointer = "/vehicle/start_s_m",
      .s_m = vehicle.start_s_m,
      .way_pointer = vehicle.route.empty() ? "/vehicle/track" : "/vehicle/route",
      .runs_back = runs_back,
      .front_s_m = length.MovedFrom(vehicle.start_s_m, runs_back ? -ahead_m : ahead_m)};
  if (!CheckFits(standing, path.route(), length, faults)) return;
  CheckTurnoutsBelow(standing, tracks, path.route(), length, faults);
}

}  // namespace railcast
