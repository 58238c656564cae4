#pragma once

#include <set>
#include <string>
#include <vector>

#include "core/rail/network/world_tracks.h"
#include "core/rail/traffic/ego_train.h"
#include "core/rail/traffic/object_draft.h"

namespace railcast {

/// Checks the tracks, places and vehicles of trains and of the sensor's own train. Faults are lines
/// like `/world/trains/0/vehicles/3/type: must be a vehicle that runs on rails (got "box")`.
void CheckTrains(const WorldSpec& world,
                 const VehicleSpec& vehicle,
                 const LineOfTracks& line,
                 WorldFaults& faults);

/// Checks that the vehicles of trains have names of their own.
/// @param names Those of everything else; receives the vehicles'.
void CheckNamesOfTrains(const WorldSpec& world, std::set<std::string>& names, WorldFaults& faults);

/// What trains are made from.
struct TrainTables {
  const TracksOfWorld& tracks;
  const Alignment& alignment;
  const ObjectTables& objects;
};

/// The vehicles of a train of the world, as far as they can be made. Reports a train that
/// is longer than its track or reaches beyond its end, and a turnout below it that is set
/// otherwise. Skips what depends on unknown values.
/// @param pointer Faults begin with it: "/world/trains/2".
[[nodiscard]] std::vector<TrainVehicle> DraftTrain(const TrainSpec& train,
                                                   const std::string& pointer,
                                                   const TrainTables& tables,
                                                   WorldFaults& faults);

/// Reports a train of the sensor's own that is longer than its track or reaches beyond its end at
/// time 0, and a turnout below it that is set otherwise.
/// @param path Of the vehicle that carries the sensor.
void CheckEgoTrain(const VehicleSpec& vehicle,
                   const TracksOfWorld& tracks,
                   const Alignment& alignment,
                   const TrackPath& path,
                   WorldFaults& faults);

}  // namespace railcast
