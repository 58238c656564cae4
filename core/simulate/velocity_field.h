#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <functional>
#include <vector>

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

}  // namespace railcast
