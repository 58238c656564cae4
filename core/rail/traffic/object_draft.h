#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/rail/base/rail_surfaces.h"
#include "core/rail/base/world_faults.h"
#include "core/rail/motion/path_way.h"
#include "core/rail/motion/track_path.h"
#include "core/rail/network/network.h"
#include "core/rail/network/world_tracks.h"
#include "core/rail/objects/object_models.h"
#include "core/rail/traffic/object_way.h"
#include "core/rail/traffic/trains.h"
#include "railcast/alignment.h"
#include "railcast/frame.h"
#include "railcast/scene.h"
#include "railcast/world_spec.h"

namespace railcast {

/// The line and the tracks beside which things of the map are placed.
struct MappedTracks {
  const WorldSpec& world;
  const NetworkDraft& network;
  const Alignment* alignment{};  ///< Null if it is not known as a whole.
};

/// Turns places on the map (x_m and y_m, or longitude_deg and latitude_deg) into those that the
/// world is made of: the object's own into s_m and d_m beside its track or route, those of its path
/// into x_m and y_m of the world.
///
/// The object's place must lie on the ground, nearer to one place of the line than to any other,
/// and beside the track. A rail vehicle that has not left the track stands on its axis, from which
/// the place may be kOffTrack_m away. Faults begin with `pointer`; what cannot be placed is
/// unknown.
void PlaceFromMap(const MappedTracks& tracks,
                  const std::string& pointer,
                  ObjectSpec& object,
                  WorldFaults& faults);

/// Maps show tracks to this, and tracks are 3 m apart at least.
inline constexpr double kOffTrack_m = 1.5;

/// What objects are made from. Where names of surfaces are faulty, default surfaces stand for them,
/// so that an object's shape can still be made and checked.
struct ObjectTables {
  const RailSurfaces& surfaces;
  const LabelTable& labels;
  ObjectModels& models;
};

/// The tracks of a world with their courses; those with faults are absent.
struct TracksOfWorld {
  const WorldSpec& world;
  const NetworkDraft& network;
};

/// Makes the path of an object, or nothing if a value it depends on is unknown. Faults begin with
/// `pointer`.
[[nodiscard]] std::optional<TrackPath> DraftPath(const TracksOfWorld& tracks,
                                                 const ObjectSpec& object,
                                                 const std::string& pointer,
                                                 std::int64_t begin_ns,
                                                 WorldFaults& faults);
/// What the object is, for messages and for its turns.
struct DraftedObject {
  const ObjectSpec& spec;
  const SceneObject& object;
  const std::string& pointer;
};
/// Adds an object's walk to its path along its track.
[[nodiscard]] ObjectPath DraftObjectPath(const PathGround& ground,
                                         const DraftedObject& drafted,
                                         TrackPath track,
                                         WorldFaults& faults);
/// As DraftPath(), for the vehicle that carries the sensor.
[[nodiscard]] std::optional<TrackPath> DraftVehiclePath(const VehicleSpec& vehicle,
                                                        const TracksOfWorld& tracks,
                                                        WorldFaults& faults);
/// As DraftPath(), for the object itself, without its `moves` and `instance`.
[[nodiscard]] std::optional<SceneObject> DraftObject(const ObjectSpec& object,
                                                     const std::string& pointer,
                                                     const ObjectTables& tables,
                                                     WorldFaults& faults);

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
