#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/rail/base/rail_surfaces.h"
#include "core/rail/catenary/catenary_plan.h"
#include "core/rail/landform/elevation.h"
#include "core/rail/landform/strip_width.h"
#include "core/rail/motion/path_draft.h"
#include "core/rail/motion/track_path.h"
#include "core/rail/network/network.h"
#include "core/rail/objects/object_models.h"
#include "core/rail/traffic/object_way.h"
#include "core/rail/world/world_check.h"
#include "railcast/alignment.h"
#include "railcast/frame.h"
#include "railcast/material.h"
#include "railcast/rail_world.h"
#include "railcast/scene.h"

namespace railcast {

/// Input from which a railway world is made.
struct WorldSource {
  const WorldSpec& world;
  const VehicleSpec& vehicle;
  const LabelTable& labels;
  const MaterialLibrary& materials;
};

/// What objects are made from. Where names of surfaces are faulty, default surfaces stand for them,
/// so that an object's shape can still be made and checked.
struct ObjectTables {
  const RailSurfaces& surfaces;
  const LabelTable& labels;
  ObjectModels& models;
};

/// The parts of a world, as far as their specs are valid; complete if there was no fault.
struct WorldDraft {
  WorldSpec world;  ///< With the tracks of its yards.
  std::optional<Alignment> alignment;
  NetworkDraft network;
  std::optional<RailSurfaces> surfaces;
  std::optional<TrackPath> vehicle_path;
  /// Those of the objects of the world, then the vehicles of its trains.
  std::vector<ObjectPath> object_paths;
  std::vector<SceneObject> objects;
  std::optional<CatenaryPlan> catenary_plan;
  std::optional<StripWidth> strip_width;
  std::optional<DemHeights> elevation;  ///< If the spec has any.
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
/// As DraftPath(), for the object itself, without its `moves` and `instance`.
[[nodiscard]] std::optional<SceneObject> DraftObject(const ObjectSpec& object,
                                                     const std::string& pointer,
                                                     const ObjectTables& tables,
                                                     WorldFaults& faults);

/// Makes every part that can be made and adds all faults found in doing so. Values that `faults`
/// marks as unknown are skipped, and so is everything that depends on them.
[[nodiscard]] WorldDraft DraftWorld(const WorldSource& source, WorldFaults& faults);

/// The places of all moving booms on their tracks, two for each level crossing.
[[nodiscard]] std::vector<TrackPath> BoomPaths(const WorldDraft& draft);

}  // namespace railcast
