#pragma once

#include <cstdint>
#include <vector>

#include "core/scene/empty_world.h"
#include "railcast/c_api.h"
#include "railcast/frame.h"
#include "railcast/material.h"
#include "railcast/ray_caster.h"
#include "railcast/transform.h"

namespace railcast {

/// The time of a frame.
struct FrameTime {
  std::int64_t stamp_ns{};
  std::uint32_t duration_ns{};  ///< To the last firing.
};

/// The world of a host's scene during one frame: the vehicle's motion, and nothing else.
class HostMotion final : public EmptyWorld {
 public:
  /// The two parts of a pose, which change independently.
  struct Pose {
    Vector3 position_m;
    Eigen::Quaterniond rotation;
  };

  /// @throws ArgumentError "motion.world_from_sensor.position_m[0]: must be finite (got nan)".
  HostMotion(const railcast_motion& motion,
             const FrameTime& time,
             const Transform& vehicle_from_sensor);

  /// The axes of the rays that the host gets.
  [[nodiscard]] Transform window_from_world() const;

  /// Between the two poses the position changes linearly and the rotation at a constant rate.
  [[nodiscard]] Transform WorldFromVehicle(std::int64_t time_ns) const override;

 private:
  Pose begin_;
  Pose end_;
  Vector3 scene_origin_m_;
  FrameTime time_;
  Transform sensor_from_vehicle_;
};

/// A transform as the C interface has it, with w >= 0.
[[nodiscard]] railcast_pose PoseOf(const Transform& transform);

/// Passes rays to a host's callback and checks what it writes, because a wrong index or a normal of
/// length 0 would otherwise end in a crash or in NaN.
class HostCaster final : public RayCaster {
 public:
  /// @pre `surfaces` outlives the caster.
  HostCaster(railcast_cast_rays cast_rays, void* user, const std::vector<Surface>& surfaces)
      : cast_rays_(cast_rays), user_(user), surfaces_(surfaces) {}

  /// @throws CallbackError "the callback returned 3" or "callback: ray 7 of 256: surface: must be
  ///   less than 4 (got 9)".
  void Cast(RayTile& tile) const override;

 private:
  railcast_cast_rays cast_rays_;
  void* user_;
  const std::vector<Surface>& surfaces_;
};

/// The names that a table of surfaces refers to.
struct SurfaceNames {
  LabelTable labels;
  MaterialLibrary materials;
};

/// A host's table of surfaces as ray casters have it.
/// @throws ArgumentError with a line for every fault: "surfaces[2].material: unknown material, the
///   nearest is "concrete" (got "concret")".
[[nodiscard]] std::vector<Surface> SurfacesOf(const railcast_surface* surfaces,
                                              std::size_t num_surfaces,
                                              const SurfaceNames& names);

}  // namespace railcast
