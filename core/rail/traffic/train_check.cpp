#include "core/rail/traffic/train_check.h"

#include <cstddef>
#include <vector>

#include "core/base/text.h"
#include "core/rail/traffic/train_places.h"

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

}  // namespace railcast
