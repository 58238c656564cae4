#pragma once

#include <condition_variable>
#include <cstdint>
#include <future>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "core/detect/wire_set.h"
#include "core/scene/material.h"
#include "core/scene/world.h"
#include "core/trace/surface.h"
#include "core/trace/trace_scene.h"

namespace railcast {

/// Everything that stands within reach of the vehicle while it is in one chunk, in that chunk's
/// frame. A function of the home chunk alone.
struct Window {
  Transform window_from_world;
  std::vector<Surface> surfaces;  ///< 0 = nothing, then the objects' parts, then the chunks'.
  std::unique_ptr<const TraceScene> scene;
  WireSet wires;  ///< What `scene` holds as tubes, once more.
};

/// Makes windows: now when asked, or ahead of need on a thread of its own. Thread-safe.
///
/// Memory holds two windows, the one in use and the one prepared, and besides them the chunks and
/// models of the window built last.
class WindowSource {
 public:
  WindowSource(std::shared_ptr<const World> world,
               const MaterialLibrary& materials,
               double range_max_m,
               const std::string& isa);
  ~WindowSource();
  WindowSource(const WindowSource&) = delete;
  WindowSource& operator=(const WindowSource&) = delete;

  /// The window of a home chunk, from now on the one in use; builds it or waits for it where it is
  /// not ready. Throws what building it threw, here or in the background, and forgets it: the next
  /// call tries again.
  [[nodiscard]] std::shared_ptr<const Window> Get(int home_chunk);
  /// Begins to build a window in the background. Does nothing if that window is there or on its
  /// way, or while another is on its way.
  void Prepare(int home_chunk);

  [[nodiscard]] const TraceDevice& device() const { return device_; }
  /// Objects ready to be traced, and the index of the surface of their first part.
  [[nodiscard]] const std::shared_ptr<const TraceModel>& object_model(std::size_t object) const {
    return object_models_[object];
  }
  [[nodiscard]] std::uint32_t object_surface(std::size_t object) const {
    return object_surfaces_[object];
  }

 private:
  struct BuiltChunk {
    std::shared_ptr<const TraceModel> ground;
    Model ground_surfaces;  // Parts without triangles.
    std::vector<Placement> placements;
    std::vector<Wire> wires;
  };

  using FutureWindow = std::shared_future<std::shared_ptr<const Window>>;
  using WindowTask = std::packaged_task<std::shared_ptr<const Window>()>;

  [[nodiscard]] std::shared_ptr<const Window> Build(int home_chunk);
  [[nodiscard]] std::shared_ptr<const BuiltChunk> GetChunk(int chunk);
  void KeepOnly(const std::vector<int>& chunks);
  [[nodiscard]] std::shared_ptr<const TraceModel> GetModel(
      const std::shared_ptr<const Model>& model);
  [[nodiscard]] Surface MakeSurface(const Part& part, std::uint32_t instance, bool is_ego) const;
  void AddObjects(int home_chunk, Window& window, std::vector<TracePlacement>& placements) const;
  [[nodiscard]] WindowTask Remember(int home_chunk);
  void ForgetOthers();
  void BuildAhead();

  std::shared_ptr<const World> world_;
  std::vector<Material> materials_;
  double range_max_m_;
  TraceDevice device_;
  std::vector<std::shared_ptr<const TraceModel>> object_models_;
  std::vector<std::uint32_t> object_surfaces_;
  std::vector<Surface> fixed_surfaces_;  // Nothing and the objects' parts.

  // Only the thread that builds (one at a time, build_mutex_) touches these.
  std::mutex build_mutex_;
  std::map<int, std::shared_ptr<const BuiltChunk>> chunks_;
  std::map<const Model*, std::pair<std::shared_ptr<const Model>, std::shared_ptr<const TraceModel>>>
      models_;

  std::mutex mutex_;
  std::condition_variable changed_;
  std::map<int, FutureWindow> windows_;  // Of in_use_ and prepared_.
  std::optional<int> in_use_;
  std::optional<int> prepared_;
  std::optional<WindowTask> ahead_;  // Waits for the builder, or is being built by it.
  bool stopping_ = false;
  std::thread builder_;
};

}  // namespace railcast
