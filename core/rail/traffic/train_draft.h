#pragma once

#include <string>

#include "core/rail/world/world_draft.h"

namespace railcast {

/// What trains are made from.
struct TrainTables {
  const TracksOfWorld& tracks;
  const Alignment& alignment;
  const ObjectTables& objects;
};

/// Adds the vehicles of a train to the objects of a world, each with its path. Reports a train that
/// is longer than its track or reaches beyond its end, and a turnout below it that is set
/// otherwise. Skips what depends on unknown values.
/// @param pointer Faults begin with it: "/world/trains/2".
void DraftTrain(const TrainSpec& train,
                const std::string& pointer,
                const TrainTables& tables,
                WorldFaults& faults,
                WorldDraft& draft);

/// Reports a train of the sensor's own that is longer than its track or reaches beyond its end at
/// time 0, and a turnout below it that is set otherwise.
/// @param path Of the vehicle that carries the sensor.
void CheckOwnTrain(const VehicleSpec& vehicle,
                   const TracksOfWorld& tracks,
                   const Alignment& alignment,
                   const TrackPath& path,
                   WorldFaults& faults);

}  // namespace railcast
