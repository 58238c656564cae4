#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/frame/labels.h"
#include "core/rail/catenary/catenary_plan.h"
#include "core/rail/line/alignment.h"
#include "core/rail/line/track_path.h"
#include "core/rail/rail_surfaces.h"
#include "core/rail/world_check.h"
#include "core/rail/world_spec.h"
#include "core/scene/material.h"
#include "core/scene/world.h"

namespace railcast {

/// What a railway world is made from.
struct WorldSource {
  const WorldSpec& world;
  const VehicleSpec& vehicle;
  const LabelTable& labels;
  const MaterialLibrary& materials;
};

/// What objects are made with. Without surfaces, which only their own faults lack, a shape can
/// still be made.
struct ObjectTables {
  const std::optional<RailSurfaces>& surfaces;
  const LabelTable& labels;
  const MaterialLibrary& materials;
};

/// The parts of a world, as far as their specs are sound: all of them if there was no fault.
struct WorldDraft {
  std::optional<Alignment> alignment;
  std::optional<RailSurfaces> surfaces;
  std::optional<TrackPath> vehicle_path;
  std::vector<TrackPath> object_paths;
  std::vector<SceneObject> objects;
  std::optional<CatenaryPlan> catenary_plan;
};

/// What is not known of `object` is left out; its faults begin with `pointer`.
[[nodiscard]] std::optional<TrackPath> DraftPath(const WorldSpec& world,
                                                 const ObjectSpec& object,
                                                 const std::string& pointer,
                                                 std::int64_t begin_ns,
                                                 WorldFaults& faults);
/// The same of what it is; without `moves` and `instance`.
[[nodiscard]] std::optional<SceneObject> DraftObject(const ObjectSpec& object,
                                                     const std::string& pointer,
                                                     const ObjectTables& tables,
                                                     WorldFaults& faults);

/// Makes what can be made and adds every fault that shows in doing so. What `faults` does not know
/// is left out, and so is what depends on it.
[[nodiscard]] WorldDraft DraftWorld(const WorldSource& source, WorldFaults& faults);

}  // namespace railcast
