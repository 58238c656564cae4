#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "railcast/scene.h"
#include "railcast/transform.h"

namespace railcast {

/// The velocity of every point of a moving thing at an instant, an affine function of its place in
/// the window frame: v = field (x, y, z, 1), m/s.
using VelocityField = Eigen::Matrix<double, 3, 4>;

/// The fields of a thing at equal steps of a frame's shutter; one if the frame has no duration.
using VelocityFields = std::vector<VelocityField>;

/// The places (window from thing) of things at a time since the stamp.
using PlacesAt = std::function<std::vector<Eigen::Affine3d>(std::int64_t since_stamp_ns)>;

/// The fields of things, by thing, at `num_intervals` + 1 steps of a frame.
///
/// Derivatives of the places by quadratics through three of them, 0.5 ms apart, none of which is
/// before the stamp: what starts with the frame has stood still before. Of a part of the motion
/// that is a wave of the angular frequency w, they are wrong by (w 0.5 ms)^2 / 3 of themselves:
/// 0.005 % at 4 Hz, the steps of a runner.
[[nodiscard]] std::vector<VelocityFields> VelocityFieldsOf(const PlacesAt& places_at,
                                                           std::int64_t duration_ns,
                                                           std::int64_t num_intervals);

/// The velocity of the point that is at `place_m`, linear between the steps.
/// @param shutter From 0, the stamp, to 1, the last firing.
[[nodiscard]] Vector3 VelocityAt_mps(const VelocityFields& fields,
                                     double shutter,
                                     const Vector3& place_m);

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
