#pragma once

#include <cstdint>

#include "core/rail/line/track_course.h"
#include "railcast/motion_sensors.h"
#include "railcast/rail_world.h"

namespace railcast {

/// The way that a vehicle has come, measured along its own track in space.
class TrackOdometry {
 public:
  /// @param world As it is at time 0.
  explicit TrackOdometry(const RailWorld& world);

  struct State {
    double distance_m{};  ///< Since time 0, in the direction of travel.
    double speed_mps{};
    /// Work done on the vehicle since time 0, per mass: the gain in kinetic and potential energy.
    double work_m2_per_s2{};
    double speeding_up_m{};   ///< Distance with rising speed.
    double slowing_down_m{};  ///< Distance with falling speed.
  };
  /// @param world This world or one that WithVehicleSpeed() made of it.
  [[nodiscard]] State At(const RailWorld& world, std::int64_t time_ns) const;

 private:
  [[nodiscard]] double Height_m(const RailWorld& world, double s_m) const;

  TrackLength length_;
  double begin_s_m_;
  double begin_height_m_;
  double begin_speed_mps_;
};

/// How far the circumference of an odometer's wheel has turned.
///
/// A wheel on which the vehicle is driven or braked creeps: it turns by the share c F / (mu N) more
/// than it rolls, with the force F at its rim, the load N, the coefficient of adhesion mu and
/// c = creep_at_adhesion (the linear part of Carter 1926; Kalker 1967). If all wheels share the
/// load alike, F / N is (a + g x gradient) / g, and the creep adds up to c / (mu g) times the work
/// per mass, whatever the motion was. Beyond the adhesion limit creep goes on growing alike.
/// Running resistance is left out. The given slips of traction and braking come on top.
[[nodiscard]] double WheelTravel_m(const OdometerSpec& spec, const TrackOdometry::State& state);

/// What an odometer measures.
[[nodiscard]] OdometerSample MeasureOdometer(const OdometerSpec& spec,
                                             const TrackOdometry& odometry,
                                             const RailWorld& world,
                                             std::uint64_t sample);

}  // namespace railcast
