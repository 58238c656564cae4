#include "core/motion/odometer.h"

#include <cmath>
#include <numbers>

#include "core/base/units.h"
#include "core/motion/imu.h"
#include "core/motion/sample_times.h"
#include "core/rail/line/track_course.h"

namespace railcast {
namespace {

/// Circumference per pulse.
double PulseLength_m(const OdometerSpec& spec, double diameter_m) {
  return std::numbers::pi * diameter_m / spec.pulses_per_revolution;
}

std::int64_t PulsesAt(const OdometerSpec& spec, const TrackOdometry::State& state) {
  const double true_diameter_m = spec.true_wheel_diameter_m.value_or(spec.wheel_diameter_m);
  return static_cast<std::int64_t>(
      std::floor(WheelTravel_m(spec, state) / PulseLength_m(spec, true_diameter_m)));
}

}  // namespace

TrackOdometry::TrackOdometry(const RailWorld& world)
    : length_(world.alignment(), world.vehicle_course()),
      begin_s_m_(world.VehicleChainage_m(0)),
      begin_height_m_(Height_m(world, begin_s_m_)),
      begin_speed_mps_(world.VehicleSpeed_mps(0)) {}

double TrackOdometry::Height_m(const RailWorld& world, double s_m) const {
  return world.vehicle_course().WorldFromTrack(world.alignment(), s_m).translation().z();
}

TrackOdometry::State TrackOdometry::At(const RailWorld& world, std::int64_t time_ns) const {
  const VehicleTravel travel = world.VehicleTravelAt(time_ns);
  const double direction = travel.runs_back ? -1.0 : 1.0;
  const double speed_mps = travel.speed_mps;
  // Length changes so evenly with chainage that its mean over 1 m is its slope.
  const double length_per_chainage =
      length_.UpTo(travel.s_m + 0.5) - length_.UpTo(travel.s_m - 0.5);
  State state;
  state.distance_m = direction * (length_.UpTo(travel.s_m) - length_.UpTo(begin_s_m_));
  state.speed_mps = speed_mps * length_per_chainage;
  state.work_m2_per_s2 = 0.5 * (speed_mps * speed_mps - begin_speed_mps_ * begin_speed_mps_) +
                         kGravity_mps2 * (Height_m(world, travel.s_m) - begin_height_m_);
  state.speeding_up_m = travel.speeding_up_m;
  state.slowing_down_m = travel.slowing_down_m;
  return state;
}

double WheelTravel_m(const OdometerSpec& spec, const TrackOdometry::State& state) {
  double travel_m = state.distance_m + spec.traction_slip_share * state.speeding_up_m -
                    spec.braking_slip_share * state.slowing_down_m;
  if (spec.adhesion) {
    travel_m += spec.creep_at_adhesion / (*spec.adhesion * kGravity_mps2) * state.work_m2_per_s2;
  }
  return travel_m;
}

OdometerSample MeasureOdometer(const OdometerSpec& spec,
                               const TrackOdometry& odometry,
                               const RailWorld& world,
                               std::uint64_t sample) {
  OdometerSample measured;
  measured.time_ns = SampleTimeNs(sample, spec.rate_hz);
  const std::int64_t before_ns =
      sample > 0 ? SampleTimeNs(sample - 1, spec.rate_hz) : -SampleTimeNs(1, spec.rate_hz);
  const TrackOdometry::State now = odometry.At(world, measured.time_ns);
  measured.pulses = PulsesAt(spec, now);
  measured.true_distance_m = now.distance_m;
  measured.true_speed_mps = now.speed_mps;
  const double pulse_m = PulseLength_m(spec, spec.wheel_diameter_m);
  measured.distance_m = pulse_m * static_cast<double>(measured.pulses);
  const std::int64_t num_pulses = measured.pulses - PulsesAt(spec, odometry.At(world, before_ns));
  measured.speed_mps =
      pulse_m * static_cast<double>(num_pulses) / SecondsFromNs(measured.time_ns - before_ns);
  return measured;
}

}  // namespace railcast
