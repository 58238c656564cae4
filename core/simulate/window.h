#pragma once

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <future>
#include <map>
#include <memory>
#include <mutex>
#include <numbers>
#include <optional>
#include <thread>
#include <vector>

#include "core/detect/beam/wire_set.h"
#include "core/simulate/scene_store.h"
#include "core/simulate/swaying.h"
#include "core/trace/trace_scene.h"
#include "railcast/ray_caster.h"
#include "railcast/simulator.h"

namespace railcast {

/// All stationary geometry within reach of the vehicle while it is in one chunk, in that chunk's
/// frame. Depends only on the home chunk, on which objects are stationary, and on whether there is
/// wind: trees and wires that the wind moves are listed, but not part of the scene. How coarse the
/// models of plants are follows from the home chunk, too, so that nothing changes its shape while
/// the vehicle is in one chunk.
struct Window {
  Transform window_from_world;
  std::vector<Surface> surfaces;  ///< 0 = nothing, then the parts of objects, then those of chunks.
  std::unique_ptr<const TraceScene> scene;
  WireSet wires;  ///< The wires that `scene` also contains as tubes.
  SwayingThings swaying;
  bool may_be_coarser{};  ///< Whether its rule permits anything but full detail in it.
  /// The pieces of the stationary objects: their objects' indices in the store's world, and their
  /// places.
  std::vector<std::size_t> standing;
  std::vector<TracePlacement> standing_placements;

  /// The stationary objects without anything else, in the order of `standing`; made on the first
  /// call. Thread-safe.
  [[nodiscard]] std::shared_ptr<const TraceScene> StandingAlone(const TraceDevice& device) const;

 private:
  mutable std::once_flag standing_once_;
  mutable std::shared_ptr<const TraceScene> standing_alone_;
};

class DetailChoice;

/// The azimuths in the vehicle's frame to which a sensor's firings go.
struct ScanSector {
  double middle_rad = 0.0;
  double half_width_rad = std::numbers::pi;  ///< A right angle or more counts as all around.
};

/// How coarse the models in a window may be for its sensor; DetailChoice applies it.
struct DetailRule {
  Transform vehicle_from_sensor = Transform::Identity();
  double ray_spacing_rad = 0.0;  ///< Angle between neighbouring firings; 0 = full detail.
  double beam_width_rad = 0.0;   ///< The lesser divergence; 0 = rays without width.
  ScanSector sector{};           ///< What no firing can meet may always be coarse.
};

/// Makes windows, either on demand or ahead of time on a background thread. Thread-safe.
///
/// It keeps two windows with their chunks, the one in use and the one prepared, and as many earlier
/// ones as it is told to; whoever uses an earlier one keeps that, too.
class WindowSource {
 public:
  /// Objects are those of the store's world; at first, all that do not move are part of the
  /// windows.
  WindowSource(std::shared_ptr<SceneStore> store,
               double range_max_m,
               const DetailRule& detail = {});
  ~WindowSource();
  WindowSource(const WindowSource&) = delete;
  WindowSource& operator=(const WindowSource&) = delete;

  /// Returns the window of a home chunk, which becomes the one in use; builds it, or waits for it,
  /// if necessary. If building failed, here or in the background, rethrows the exception and
  /// discards the window, so that the next call tries again.
  [[nodiscard]] std::shared_ptr<const Window> Get(int home_chunk);
  /// Starts building a window in the background. Does nothing if the window exists or is being
  /// built, or if another one is being built.
  void Prepare(int home_chunk);

  /// Sets which objects are part of the windows from now on, in ascending order. If the set
  /// changes, windows are rebuilt from existing chunks and models.
  /// @pre None of the objects moves.
  void UseStanding(std::vector<std::size_t> objects);

  /// Sets whether there is wind from now on; at first, there is none. If that changes, windows are
  /// rebuilt.
  void UseWind(bool blows);

  /// Sets how many windows are kept besides the one in use and the one prepared, the latest that
  /// were in use; at first, none.
  void UseKept(std::size_t num);

  /// Sets the callback for windows that are begun from now on.
  void UseProgress(WindowProgress progress);

  [[nodiscard]] const SceneStore::StoredObject& object(std::size_t object) const {
    return objects_[object];
  }
  /// Surface index of an object's first part; the same in every window.
  [[nodiscard]] std::uint32_t object_surface(std::size_t object) const {
    return object_surfaces_[object];
  }

 private:
  using FutureWindow = std::shared_future<std::shared_ptr<const Window>>;
  using WindowTask = std::packaged_task<std::shared_ptr<const Window>()>;
  using Standing = std::shared_ptr<const std::vector<std::size_t>>;
  using Chunks = std::map<int, std::shared_ptr<const SceneStore::BuiltChunk>>;

  using Models = std::vector<std::shared_ptr<const TraceModel>>;

  /// What windows are made for.
  struct Purpose {
    Standing standing;
    bool wind_blows{};
    WindowProgress progress;
  };

  /// Whether a frame waits for a window, whose parts are then built on all of the caller's TBB
  /// threads, or it is built ahead by one thread beside the frames.
  enum class Pace { kAwaited, kAhead };

  /// Calls `work(i)` for each i below `num`.
  template <typename Work>
  static void ForEach(std::size_t num, Pace pace, const Work& work);
  [[nodiscard]] Chunks GetChunks(int home_chunk,
                                 const Purpose& purpose,
                                 const DetailChoice& choice,
                                 Pace pace);
  [[nodiscard]] std::shared_ptr<const Window> Build(int home_chunk,
                                                    const Purpose& purpose,
                                                    Pace pace);
  void AddObjects(int home_chunk, const std::vector<std::size_t>& standing, Window& window) const;
  /// The models in which the placements of all chunks are traced, in their order.
  [[nodiscard]] Models GetModels(int home_chunk,
                                 const Chunks& chunks,
                                 DetailChoice& choice,
                                 Pace pace) const;
  void AddChunks(const Chunks& chunks,
                 const Models& models,
                 bool wind_blows,
                 Window& window,
                 std::vector<TracePlacement>& placements) const;
  void KeepChunks(int home_chunk, Chunks chunks);
  [[nodiscard]] WindowTask Remember(int home_chunk, Pace pace);
  [[nodiscard]] bool IsWanted(int home_chunk) const {
    return home_chunk == in_use_ || home_chunk == prepared_ ||
           std::ranges::find(kept_, home_chunk) != kept_.end();
  }
  void ForgetOthers();
  void BuildAhead();

  std::shared_ptr<SceneStore> store_;
  double range_max_m_;
  DetailRule detail_;
  std::vector<SceneStore::StoredObject> objects_;
  std::vector<std::uint32_t> object_surfaces_;
  std::vector<Surface> fixed_surfaces_;  // Surface 0 (nothing) and the objects' parts.

  std::mutex mutex_;
  std::condition_variable changed_;
  Purpose purpose_{{}, false, [](std::size_t, std::size_t) {}};
  std::map<int, FutureWindow> windows_;  // Windows of in_use_ and prepared_.
  // Chunks of the same windows, and of earlier ones until the next is built.
  std::map<int, Chunks> chunks_;
  std::optional<int> in_use_;
  std::vector<int> kept_;  // Home chunks of windows that were in use, the latest first.
  std::size_t num_kept_ = 0;
  std::optional<int> prepared_;
  std::optional<WindowTask> ahead_;  // Waits for the builder thread or is being built by it.
  std::atomic<bool> stopping_ = false;
  std::thread builder_;
};

}  // namespace railcast
