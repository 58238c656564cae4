#pragma once

#include <compare>
#include <cstdint>
#include <future>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/base/recent.h"
#include "core/trace/trace_scene.h"
#include "railcast/material.h"
#include "railcast/ray_caster.h"
#include "railcast/scene.h"

namespace railcast {

class RailWorld;

/// Models and chunks without plants that are prepared for tracing, of a single world or of all that
/// are made one after another. Thread-safe.
class TraceStock {
 public:
  /// @param most_triangles Chunks that were used last are kept up to this many triangles in all;
  ///   0 = none is.
  explicit TraceStock(const std::string& isa = {}, std::size_t most_triangles = 0)
      : device_(isa), chunks_(most_triangles) {}

  /// A chunk in one of its forms.
  struct ChunkForm {
    int chunk{};
    bool has_tubes = true;  ///< Whether `ground` holds the wires as tubes.
    std::size_t level = 0;  ///< Level of World::BuildCoarserChunk(); 0 = the finest.
    auto operator<=>(const ChunkForm&) const = default;
  };
  /// A chunk without plants, if these are made apart.
  struct BareChunk {
    std::shared_ptr<const TraceModel> ground;
    Model ground_surfaces;  ///< The ground's parts without their triangles.
    std::vector<Placement> placements;
    std::vector<Wire> wires;
    std::size_t num_triangles{};  ///< Triangles of the ground.
  };
  [[nodiscard]] std::shared_ptr<const BareChunk> GetChunk(const RailWorld& world,
                                                          const ChunkForm& form);
  /// Prepares a chunk, of which `made` has all but the trees.
  [[nodiscard]] std::shared_ptr<const BareChunk> Prepare(Chunk made, const ChunkForm& form) const;
  /// @param is_object Whether it is made for TraceScene::CastThrough().
  [[nodiscard]] std::shared_ptr<const TraceModel> GetModel(
      const std::shared_ptr<const Model>& model, bool is_object = false);
  /// Drops the models that no world and no chunk uses any more.
  void ForgetUnusedModels();
  [[nodiscard]] const TraceDevice& device() const { return device_; }

 private:
  TraceDevice device_;
  // By RailWorld::bare_line().
  Recent<std::pair<std::shared_ptr<const void>, ChunkForm>, BareChunk> chunks_;
  std::mutex models_mutex_;
  // By model and whether it is an object's.
  std::map<std::pair<const Model*, bool>,
           std::pair<std::shared_ptr<const Model>, std::shared_ptr<const TraceModel>>>
      models_;
};

/// The chunks and models of a world, prepared for tracing once for all sensors of a run. Chunks are
/// kept as long as they are in use. Thread-safe.
class SceneStore {
 public:
  SceneStore(std::shared_ptr<const World> world,
             const MaterialLibrary& materials,
             std::shared_ptr<TraceStock> stock = std::make_shared<TraceStock>());

  using ChunkForm = TraceStock::ChunkForm;
  struct BuiltChunk {
    std::shared_ptr<const TraceStock::BareChunk> bare;
    std::vector<Placement> placements;  ///< All of them.
  };
  /// Returns a chunk; builds it, or waits for another thread that is building it, if necessary.
  [[nodiscard]] std::shared_ptr<const BuiltChunk> GetChunk(const ChunkForm& form);
  /// @param is_object Whether it is made for TraceScene::CastThrough().
  [[nodiscard]] std::shared_ptr<const TraceModel> GetModel(
      const std::shared_ptr<const Model>& model, bool is_object = false) {
    return stock_->GetModel(model, is_object);
  }
  /// UnitTube(), of which wires consist that move.
  [[nodiscard]] std::shared_ptr<const TraceModel> GetUnitTube() { return GetModel(unit_tube_); }
  void ForgetUnusedModels() { stock_->ForgetUnusedModels(); }

  /// An object prepared for tracing.
  struct StoredObject {
    /// See NumPieces(). Their first surfaces are indices in `surfaces`.
    std::shared_ptr<const std::vector<TracePiece>> pieces;
    std::vector<Surface> surfaces;  ///< Surfaces of the parts of all pieces.
    double radius_m{};              ///< Radius of a sphere about its origin that contains it.
  };
  [[nodiscard]] StoredObject MakeObject(const SceneObject& object);

  /// Called when a simulator is going to cast beams: windows are prepared for it from now on.
  /// @param labels As FrameScenes::UseBeams().
  void UseBeams(const std::vector<std::uint32_t>& labels);
  /// All sets of labels that beams are cast with.
  [[nodiscard]] std::set<std::vector<std::uint32_t>> labels_of_beams() const;

  [[nodiscard]] Surface MakeSurface(const Part& part, std::uint32_t instance, bool is_ego) const;
  /// Whether any of the surfaces has a texture.
  [[nodiscard]] bool HasTexture(const std::vector<Surface>& surfaces) const;
  [[nodiscard]] const std::shared_ptr<const World>& world() const { return world_; }
  [[nodiscard]] const TraceDevice& device() const { return stock_->device(); }

 private:
  std::shared_ptr<const World> world_;
  std::shared_ptr<const RailWorld> rail_world_;  ///< The same, if it is one.
  std::vector<Material> materials_;
  std::shared_ptr<const Model> unit_tube_;
  std::shared_ptr<TraceStock> stock_;
  mutable std::mutex labels_of_beams_mutex_;
  std::set<std::vector<std::uint32_t>> labels_of_beams_;

  struct ChunkEntry {
    std::weak_ptr<const BuiltChunk> built;
    /// Valid while a thread builds the chunk.
    std::shared_future<std::shared_ptr<const BuiltChunk>> being_built;
  };
  [[nodiscard]] std::shared_ptr<const BuiltChunk> BuildChunk(const ChunkForm& form) const;

  std::mutex chunks_mutex_;
  std::map<ChunkForm, ChunkEntry> chunks_;
};

}  // namespace railcast
