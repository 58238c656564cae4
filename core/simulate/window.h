#pragma once

#include <condition_variable>
#include <cstdint>
#include <future>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "core/detect/wire_set.h"
#include "core/simulate/scene_store.h"
#include "core/simulate/window_progress.h"
#include "core/trace/surface.h"
#include "core/trace/trace_scene.h"

namespace railcast {

/// Everything that stands within reach of the vehicle while it is in one chunk, in that chunk's
/// frame. A function of the home chunk and of which objects stand.
struct Window {
  Transform window_from_world;
  std::vector<Surface> surfaces;  ///< 0 = nothing, then the objects' parts, then the chunks'.
  std::unique_ptr<const TraceScene> scene;
  WireSet wires;  ///< What `scene` holds as tubes, once more.
};

/// Makes windows: now when asked, or ahead of need on a thread of its own. Thread-safe.
///
/// Memory holds two windows, the one in use and the one prepared, and their chunks.
class WindowSource {
 public:
  /// Objects are those of the store's world; all of them stand that do not move.
  WindowSource(std::shared_ptr<SceneStore> store, double range_max_m);
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

  /// Which of the objects stand in the windows from now on, ascending. Where that changes, windows
  /// are made anew, of chunks and models that are there.
  /// @pre None of them moves.
  void UseStanding(std::vector<std::size_t> objects);

  /// Of the windows that are begun from now on.
  void UseProgress(WindowProgress progress);

  [[nodiscard]] const SceneStore::StoredObject& object(std::size_t object) const {
    return objects_[object];
  }
  /// The index of the surface of an object's first part, in every window.
  [[nodiscard]] std::uint32_t object_surface(std::size_t object) const {
    return object_surfaces_[object];
  }

 private:
  using FutureWindow = std::shared_future<std::shared_ptr<const Window>>;
  using WindowTask = std::packaged_task<std::shared_ptr<const Window>()>;
  using Standing = std::shared_ptr<const std::vector<std::size_t>>;
  using Chunks = std::map<int, std::shared_ptr<const SceneStore::BuiltChunk>>;

  [[nodiscard]] std::shared_ptr<const Window> Build(int home_chunk,
                                                    const Standing& standing,
                                                    const WindowProgress& progress);
  void AddObjects(int home_chunk,
                  const std::vector<std::size_t>& standing,
                  Window& window,
                  std::vector<TracePlacement>& placements) const;
  void AddChunks(const Chunks& chunks,
                 Window& window,
                 std::vector<TracePlacement>& placements) const;
  void KeepChunks(int home_chunk, Chunks chunks);
  [[nodiscard]] WindowTask Remember(int home_chunk);
  [[nodiscard]] bool IsWanted(int home_chunk) const {
    return home_chunk == in_use_ || home_chunk == prepared_;
  }
  void ForgetOthers();
  void BuildAhead();

  std::shared_ptr<SceneStore> store_;
  double range_max_m_;
  std::vector<SceneStore::StoredObject> objects_;
  std::vector<std::uint32_t> object_surfaces_;
  std::vector<Surface> fixed_surfaces_;  // Nothing and the objects' parts.

  std::mutex mutex_;
  std::condition_variable changed_;
  Standing standing_;
  WindowProgress progress_ = [](std::size_t, std::size_t) {};
  std::map<int, FutureWindow> windows_;  // Of in_use_ and prepared_.
  std::map<int, Chunks> chunks_;         // The same, and of earlier ones until the next is built.
  std::optional<int> in_use_;
  std::optional<int> prepared_;
  std::optional<WindowTask> ahead_;  // Waits for the builder, or is being built by it.
  bool stopping_ = false;
  std::thread builder_;
};

}  // namespace railcast
