#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <utility>

#include "core/simulate/velocity_field.h"
#include "railcast/scene.h"

namespace railcast {

/// Velocities of the surfaces of a frame, in the window frame.
class SurfaceMotions {
 public:
  /// Consecutive surfaces that move as one.
  struct Motion {
    std::uint32_t first_surface{};
    std::uint32_t num_surfaces{};
    VelocityFields fields;
    /// For wires: the span of which they are part, in the window frame. `fields` are those of its
    /// middle, and every point has its BlowOffShare() of them.
    std::optional<WireSpan> span{};
  };

  /// @pre None of its surfaces belongs to another motion.
  void Add(Motion motion) { motions_.emplace(motion.first_surface, std::move(motion)); }
  void Add(SurfaceMotions others) { motions_.merge(others.motions_); }
  /// The velocity of the point of a surface at `place_m`; 0 if no motion has the surface.
  [[nodiscard]] Vector3 VelocityOf_mps(std::uint32_t surface,
                                       double shutter,
                                       const Vector3& place_m) const;

 private:
  std::map<std::uint32_t, Motion> motions_;  // By first surface.
};

/// How everything moves in a frame, for sensors that measure velocities.
struct FrameMotion {
  VelocityFields sensor;
  SurfaceMotions surfaces;
};

}  // namespace railcast
