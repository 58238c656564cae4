#pragma once

#include <cstddef>
#include <functional>
#include <memory>

#include "core/base/units.h"
#include "railcast/simulator.h"
#include "tests/support/analytic_meshes.h"
#include "tests/support/scan_once.h"
#include "tests/support/simple_world.h"

namespace railcast {

inline constexpr VelocitySpec kExact{.sigma_mps = 0.0, .max_mps = 500.0};
// Directions and places are float32: 2e-7 of speeds up to 100 m/s.
inline constexpr double kRounding_mps = 5e-5;

[[nodiscard]] inline SimulatorSpec Measuring(const VelocitySpec& velocity = kExact) {
  return {.detector = {.velocity = velocity}};
}

[[nodiscard]] inline std::shared_ptr<const Model> SheetModel(float half_m = 200.0F,
                                                             std::uint16_t material = 2) {
  return std::make_shared<const Model>(Model{"wall", {{MakeWall(0.0F, half_m), material, 7}}});
}

[[nodiscard]] inline std::shared_ptr<SimpleWorld> WorldWithWallAt(
    double distance_m, const Vector3& wall_mps = Vector3::Zero()) {
  auto world = std::make_shared<SimpleWorld>();
  world->AddObject(SheetModel(), Transform(Eigen::Translation3d(distance_m, 0.0, 0.0)), wall_mps);
  return world;
}

/// Calls `check(slot, direction, time_s)` for every slot of a frame with one return; the direction
/// is in the sensor's axes.
inline void ForEachFiring(const Frame& frame,
                          const ScanPattern& pattern,
                          const std::function<void(std::size_t, const Vector3&, double)>& check) {
  for (std::size_t slot = 0; slot < frame.num_slots(); ++slot) {
    check(slot, DirectionOf(pattern, FiringOfSlot(pattern, frame.returns, slot)),
          SecondsFromNs(frame.stamp_ns + frame.time_ns[slot]));
  }
}

[[nodiscard]] inline double TrueAt(const Frame& frame, std::size_t slot) {
  return static_cast<double>(frame.true_radial_velocity_mps[slot]);
}
}  // namespace railcast
