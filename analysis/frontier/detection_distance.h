#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "railcast/frame.h"
#include "railcast/simulator.h"

namespace railcast {

/// How one frame sees an object on the way to it.
struct ApproachPoints {
  double distance_m{};  ///< From the sensor to the nearest point of the object's box.
  std::uint32_t points_in_reference{};
  std::uint32_t points{};
};

/// An object that comes nearer, as the reference and a row see it.
struct Approach {
  std::string object;
  std::uint32_t instance{};
  std::vector<ApproachPoints> points;  ///< By frame, in order of time.
};

/// The distance from which on an object has enough points (DetectionRule::min_points): between the
/// first frame that has them and the one before, it is interpolated in the logarithms of points and
/// distance. NaN if the first frame has them already or if it comes no nearer than the frame before
/// has been; 0 if no frame has them.
/// @param points ApproachPoints::points_in_reference or ::points.
[[nodiscard]] double DetectionDistance_m(const Approach& approach,
                                         std::uint32_t ApproachPoints::*points);

/// Mean over the objects whose detection distance the reference tells of |distance / distance of
/// the reference - 1|; NaN if there is none.
[[nodiscard]] double DetectionDistanceError(const std::vector<Approach>& approaches);

/// The objects of a world except the sensor's own vehicle, without any points.
[[nodiscard]] std::vector<Approach> ApproachesIn(const World& world);

/// Adds a frame's points on each object that is nearer than in the frame before.
/// @param reference, other The same frame of the simulator.
void AddApproach(const Simulator& simulator,
                 const Frame& reference,
                 const Frame& other,
                 std::vector<Approach>& approaches);

}  // namespace railcast
