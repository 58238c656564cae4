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
struct FrameScene final : public RayCaster {
  std::uint32_t index{};
  std::int64_t stamp_ns{};
  std::shared_ptr<const Window> window;      ///< What stands.
  std::unique_ptr<const TraceScene> moving;  ///< What moves; null if nothing does within reach.
  FramePoses poses;                          ///< Of the sensor, in the window.

  void Cast(RayTile& rays) const override;
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

  /// The sensor's poses during a frame, in any window.
  [[nodiscard]] FramePoses PosesIn(const Transform& window_from_world, std::int64_t stamp_ns) const;

  /// An object of world().objects() where it is in a frame, and nothing else.
  struct LoneObject {
    std::size_t object{};
    std::unique_ptr<const TraceScene> scene;
    Eigen::Vector3f center_window_m;  ///< Of a sphere that holds it throughout the frame.
    float radius_m{};
  };
  /// Those of the objects that are within range of the frame's sensor.
  [[nodiscard]] std::vector<LoneObject> LoneObjects(const FrameScene& frame) const;

  [[nodiscard]] const World& world() const { return *world_; }
  [[nodiscard]] Transform WorldFromSensor(std::int64_t time_ns) const {
    return world_->WorldFromVehicle(time_ns) * spec_.vehicle_from_sensor;
  }

 private:
  [[nodiscard]] TracePlacement Place(std::size_t object,
                                     std::int64_t stamp_ns,
                                     const Transform& window_from_world) const;
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

  std::shared_ptr<const World> world_;
  FrameSceneSpec spec_;
  std::vector<double> object_radii_m_;  // About the object's origin.
  WindowSource windows_;
};

}  // namespace railcast
