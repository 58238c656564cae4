#pragma once

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "core/scene/world.h"
#include "core/simulate/frame_poses.h"
#include "core/simulate/lone_object.h"
#include "core/simulate/window.h"
#include "core/trace/ray_tile.h"
#include "core/trace/trace_scene.h"

namespace railcast {

/// What the rays of one frame come from and are cast into.
struct FrameScene final : public RayCaster {
  std::uint32_t index{};
  std::int64_t stamp_ns{};
  std::shared_ptr<const Window> window;  ///< What stands.
  /// What moves or came later; null if there is nothing within reach.
  std::unique_ptr<const TraceScene> moving;
  FramePoses poses;  ///< Of the sensor, in the window.
  /// The window's and those of objects that windows know nothing of; empty if there are none.
  std::vector<Surface> more_surfaces;

  [[nodiscard]] const std::vector<Surface>& surfaces() const {
    return more_surfaces.empty() ? window->surfaces : more_surfaces;
  }

  void Cast(RayTile& rays) const override;
  void CastRanges(RayTile& rays) const;
};

/// What the frames of a run have in common.
struct FrameSceneSpec {
  double range_max_m{};
  Transform vehicle_from_sensor = Transform::Identity();
  std::uint32_t duration_ns{};  ///< From a frame's first firing to its last.
};

/// Makes the scene of any frame; each is a function of its index and of the world in use.
///
/// What stands in the store's world is part of the windows. What moves, and what a later world has
/// besides, comes into a small scene that each frame has of its own, so that it costs no window.
class FrameScenes {
 public:
  /// In use is the store's world.
  FrameScenes(std::shared_ptr<SceneStore> store, const FrameSceneSpec& spec);

  /// @param world Differs from the store's in the vehicle's way and in objects only: those of the
  ///   same model and instance id are the same.
  void UseWorld(std::shared_ptr<const World> world);

  /// Of the windows that are begun from now on.
  void UseProgress(WindowProgress progress) { windows_.UseProgress(std::move(progress)); }

  /// Waits for the window where it is not ready, and has the next one prepared.
  [[nodiscard]] FrameScene At(std::uint32_t index, std::int64_t stamp_ns);

  /// The sensor's poses during a frame, in any window.
  [[nodiscard]] FramePoses PosesIn(const Transform& window_from_world, std::int64_t stamp_ns) const;

  /// Those of the objects that are within range of the frame's sensor.
  [[nodiscard]] std::vector<LoneObject> LoneObjects(const FrameScene& frame) const;

  [[nodiscard]] const World& world() const { return *world_; }
  [[nodiscard]] const std::shared_ptr<const World>& shared_world() const { return world_; }
  [[nodiscard]] Transform WorldFromSensor(std::int64_t time_ns) const {
    return world_->WorldFromVehicle(time_ns) * spec_.vehicle_from_sensor;
  }

 private:
  [[nodiscard]] TracePlacement Place(std::size_t object,
                                     std::int64_t stamp_ns,
                                     const Window& window) const;
  /// Whether a beam of the frame may hit what is placed.
  [[nodiscard]] bool IsInReach(const TracePlacement& placement,
                               std::size_t object,
                               const Vector3& sensor_window_m) const;
  [[nodiscard]] Vector3 SensorInWindow(std::int64_t stamp_ns, const Window& window) const {
    return (window.window_from_world * WorldFromSensor(stamp_ns)).translation();
  }
  [[nodiscard]] std::unique_ptr<const TraceScene> MovingScene(std::int64_t stamp_ns,
                                                              const Window& window) const;
  void PrepareNextWindow(std::int64_t stamp_ns, int home_chunk);

  /// An object of the world in use.
  struct Object {
    SceneStore::StoredObject stored;
    /// Of its first part: of every window or, where windows know nothing of it, behind theirs.
    std::uint32_t first_surface{};
    bool is_known_to_windows{};
    bool is_in_windows{};
  };
  [[nodiscard]] std::uint32_t FirstSurface(const Object& object, const Window& window) const {
    const auto num_windows = static_cast<std::uint32_t>(window.surfaces.size());
    return object.first_surface + (object.is_known_to_windows ? 0 : num_windows);
  }

  std::shared_ptr<SceneStore> store_;
  FrameSceneSpec spec_;
  WindowSource windows_;
  std::shared_ptr<const World> world_;
  std::vector<Object> objects_;         // In the order of world_->objects().
  std::vector<Surface> more_surfaces_;  // Of those that windows know nothing of.
};

}  // namespace railcast
