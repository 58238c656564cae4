#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "core/scene/material.h"
#include "core/scene/world.h"
#include "core/trace/surface.h"
#include "core/trace/trace_scene.h"

namespace railcast {

/// What a world is traced as, built once for all sensors of a run: its chunks and models, ready to
/// be traced, each kept as long as someone uses it. Thread-safe.
class SceneStore {
 public:
  SceneStore(std::shared_ptr<const World> world,
             const MaterialLibrary& materials,
             const std::string& isa = {});

  struct BuiltChunk {
    std::shared_ptr<const TraceModel> ground;
    Model ground_surfaces;  ///< Parts without triangles.
    std::vector<Placement> placements;
    std::vector<Wire> wires;
  };
  /// Builds it or waits for it where it is not there.
  [[nodiscard]] std::shared_ptr<const BuiltChunk> GetChunk(int chunk);
  [[nodiscard]] std::shared_ptr<const TraceModel> GetModel(
      const std::shared_ptr<const Model>& model);
  /// Drops the models that are used by no world and no chunk any more.
  void ForgetUnusedModels();

  /// An object ready to be traced.
  struct StoredObject {
    std::shared_ptr<const TraceModel> model;
    std::vector<Surface> surfaces;  ///< Of its parts.
    double radius_m{};              ///< About its origin.
  };
  [[nodiscard]] StoredObject MakeObject(const SceneObject& object);

  [[nodiscard]] Surface MakeSurface(const Part& part, std::uint32_t instance, bool is_ego) const;
  [[nodiscard]] const std::shared_ptr<const World>& world() const { return world_; }
  [[nodiscard]] const TraceDevice& device() const { return device_; }

 private:
  std::shared_ptr<const World> world_;
  std::vector<Material> materials_;
  TraceDevice device_;

  std::mutex chunks_mutex_;  // Held while one is built: whoever comes second waits for it.
  std::map<int, std::weak_ptr<const BuiltChunk>> chunks_;
  std::mutex models_mutex_;
  std::map<const Model*, std::pair<std::shared_ptr<const Model>, std::shared_ptr<const TraceModel>>>
      models_;
};

}  // namespace railcast
