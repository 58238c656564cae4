#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/rail/base/world_faults.h"
#include "core/rail/catenary/catenary_plan.h"
#include "core/rail/landform/landform.h"
#include "core/rail/motion/track_path.h"
#include "core/rail/network/world_tracks.h"
#include "core/rail/survey/surveyed_scene.h"
#include "core/rail/traffic/object_draft.h"
#include "railcast/alignment.h"
#include "railcast/frame.h"
#include "railcast/material.h"
#include "railcast/scene.h"
#include "railcast/world_spec.h"

namespace railcast {

/// Input from which a railway world is made.
struct WorldSource {
  const WorldSpec& world;
  const VehicleSpec& vehicle;
  const LabelTable& labels;
  const MaterialLibrary& materials;
};

/// The parts of a world, as far as their specs are valid; complete if there was no fault.
struct WorldDraft {
  WorldSpec world;  ///< With the tracks of its yards.
  std::optional<Alignment> alignment;
  NetworkDraft network;
  std::optional<RailSurfaces> surfaces;
  std::optional<TrackPath> vehicle_path;
  /// The paths of the objects of the world, then of the vehicles of its trains.
  std::vector<ObjectPath> object_paths;
  std::vector<SceneObject> objects;
  std::optional<CatenaryPlan> catenary_plan;
  std::optional<StripWidth> strip_width;
  std::optional<DemHeights> elevation;          ///< If the spec has any.
  std::shared_ptr<const SurveyedScene> survey;  ///< If the spec has any.
};

/// Makes every part that can be made and adds all faults found in doing so. Values that `faults`
/// marks as unknown are skipped, and so is everything that depends on them.
[[nodiscard]] WorldDraft DraftWorld(const WorldSource& source, WorldFaults& faults);

/// The places of all moving booms on their tracks, two for each level crossing.
[[nodiscard]] std::vector<TrackPath> BoomPaths(const WorldDraft& draft);

/// Checks a world and its vehicle for consistency with each other and with the line. Faults are
/// lines like `/world/objects/3/track: must be one of "main", "siding" (got "sidng")`. Speed
/// profiles are checked separately (SpeedProfile), and so is the network (DraftNetwork,
/// CheckNetwork).
/// @param line Infinite measures if the line is unknown.
void CheckWorld(const WorldSpec& world,
                const VehicleSpec& vehicle,
                const LineOfTracks& line,
                WorldFaults& faults);

/// Checks the place of one object. Faults are lines that begin with `pointer`.
void CheckObject(const WorldSpec& world,
                 const ObjectSpec& object,
                 const std::string& pointer,
                 const LineOfTracks& line,
                 WorldFaults& faults);

}  // namespace railcast
