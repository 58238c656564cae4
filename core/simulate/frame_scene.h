#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/scene/material.h"
#include "core/scene/world.h"
#include "core/simulate/frame_poses.h"
#include "core/simulate/window.h"
#include "core/trace/ray_tile.h"
#include "core/trace/trace_scene.h"

namespace railcast {

/// What the rays of one frame come from and are cast into.
struct FrameScene {
  std::uint32_t index{};
  std::int64_t stamp_ns{};
  std::shared_ptr<const Window> window;      ///< What stands.
  std::unique_ptr<const TraceScene> moving;  ///< What moves; null if nothing does within reach.
  FramePoses poses;                          ///< Of the sensor, in the window.

  void Cast(RayTile& rays) const;
  void CastRanges(RayTile& rays) const;
};

/// What the frames of a run have in common.
struct FrameSceneSpec {
  double range_max_m{};
  Transform vehicle_from_sensor = Transform::Identity();
  std::uint32_t duration_ns{};  ///< From a frame's first firing to its last.
  std::string isa{};            ///< Of Embree; empty = the best there is.
};

/// Makes the scene of any frame; each is a function of its index alone.
class FrameScenes {
 public:
  FrameScenes(std::shared_ptr<const World> world,
              const MaterialLibrary& materials,
              const FrameSceneSpec& spec);

  /// Waits for the window where it is not ready, and has the next one prepared.
  [[nodiscard]] FrameScene At(std::uint32_t index, std::int64_t stamp_ns);

  /// The object of world().objects() where it is in a frame, and nothing else.
  [[nodiscard]] std::unique_ptr<const TraceScene> Alone(std::size_t object,
                                                        const FrameScene& frame) const;

  [[nodiscard]] const World& world() const { return *world_; }
  [[nodiscard]] Transform WorldFromSensor(std::int64_t time_ns) const {
    return world_->WorldFromVehicle(time_ns) * spec_.vehicle_from_sensor;
  }

 private:
  [[nodiscard]] TracePlacement Place(std::size_t object,
                                     std::int64_t stamp_ns,
                                     const Transform& window_from_world) const;
  [[nodiscard]] std::unique_ptr<const TraceScene> MovingScene(std::int64_t stamp_ns,
                                                              const Window& window) const;
  void PrepareNextWindow(std::int64_t stamp_ns, int home_chunk);

  std::shared_ptr<const World> world_;
  FrameSceneSpec spec_;
  std::vector<double> object_radii_m_;  // About the object's origin.
  WindowSource windows_;
};

}  // namespace railcast
