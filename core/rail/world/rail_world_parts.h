#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/base/recent.h"
#include "core/rail/base/rail_surfaces.h"
#include "core/rail/catenary/catenary_plan.h"
#include "core/rail/chunk/chunk_context.h"
#include "core/rail/chunk/chunk_grid.h"
#include "core/rail/ground/plant_models.h"
#include "core/rail/landform/landform.h"
#include "core/rail/motion/ride.h"
#include "core/rail/motion/track_path.h"
#include "core/rail/network/network.h"
#include "core/rail/survey/surveyed_scene.h"
#include "core/rail/track/track_structure.h"
#include "core/rail/traffic/object_draft.h"
#include "core/rail/traffic/object_way.h"
#include "core/rail/world/world_draft.h"
#include "railcast/rail_world.h"

namespace railcast {

/// What the chunks are made of but for their plants.
struct RailWorld::Line {
  WorldSpec world;  ///< Without what LineKey leaves out, and with the tracks of its yards.
  std::uint64_t seed{};
  RailSurfaces surfaces;
  Alignment alignment;
  Network network;
  std::vector<LaidTurnout> turnouts;
  std::vector<LaidDiamond> diamonds;
  ChunkGrid grid;
  CatenaryPlan catenary_plan;
  TrackModels track_models;
  std::shared_ptr<const Model> mast_model;
  Landform land;
  std::shared_ptr<const SurveyedScene> survey;  ///< Null: the line is built from the spec.
  TilesOfChunks surveyed;

  /// If `chunk_from_world` is the identity, builders work in world coordinates.
  [[nodiscard]] ChunkContext ContextOf(int chunk, const Transform& chunk_from_world) const {
    return ContextOf(chunk, chunk_from_world, world);
  }
  [[nodiscard]] Chunk Build(int chunk, std::size_t level) const;
  /// @param spec `world` with plants.
  [[nodiscard]] std::vector<Placement> PlantsOf(int chunk,
                                                const WorldSpec& spec,
                                                const PlantModels& plants) const;
  /// The booms of all level crossings whose barriers move.
  [[nodiscard]] std::vector<MovingBoom> Booms() const;
  [[nodiscard]] LineMeasures Measures() const {
    return {alignment.length_m(), alignment.tightest_radius_m()};
  }

 private:
  [[nodiscard]] ChunkContext ContextOf(int chunk,
                                       const Transform& chunk_from_world,
                                       const WorldSpec& spec) const;
  /// Calls `build` with the context of a chunk in its own frame.
  template <class Builder>
  void InContext(int chunk, const WorldSpec& spec, const Builder& build) const;
};

/// What else commands cannot change.
struct RailWorld::Setting {
  WorldSpec world;  ///< With the tracks of its yards.
  LabelTable labels;
  MaterialLibrary materials;
  std::shared_ptr<const PlantsOnDemand> plants;
  std::optional<Ride> ride;  ///< The ride of the sensor's vehicle.
  bool is_known_line{};      ///< Whether a world before has the line.

  [[nodiscard]] bool has_plants() const {
    const VegetationSpec& spec = world.vegetation;
    return !world.survey &&
           (spec.grass || spec.trees_per_hectare > 0.0 || spec.bushes_per_hectare > 0.0);
  }
};

/// The objects, and the motion of everything that moves.
struct RailWorld::Things {
  TrackPath vehicle;
  bool has_changed_vehicle_speed = false;
  // Shared between worlds, because most commands change only the vehicle's motion.
  std::shared_ptr<const std::vector<SceneObject>> objects;
  std::shared_ptr<const std::vector<ObjectWay>> ways;  ///< In the order of `objects`.
  std::uint32_t next_instance = 1;

  [[nodiscard]] const TrackPath& PathOf(std::size_t object) const {
    const std::optional<TrackPath>& path = ways->at(object).path;
    return path ? *path : vehicle;
  }
};

/// What a line is made from that has neither a survey nor a file of heights.
struct LineKey {
  WorldSpec world;  ///< Without objects, trains and plants.
  RailSurfaces surfaces;
  std::uint64_t seed{};
  std::vector<TurnoutPosition>
      positions;  ///< Positions of all turnouts; the vehicle's route has a say.

  bool operator==(const LineKey&) const = default;
};

/// @pre The draft is complete.
[[nodiscard]] LineKey KeyOf(const WorldDraft& draft, std::uint64_t seed);

struct PlantsKey {
  RailSurfaces surfaces;
  std::uint64_t seed{};

  bool operator==(const PlantsKey&) const = default;
};

struct SharedLines::Parts {
  // A recipe has tens of bases, whose plants mostly have the same seed.
  Recent<LineKey, RailWorld::Line> lines{32};
  Recent<PlantsKey, PlantsOnDemand> plants{2};
};

}  // namespace railcast
