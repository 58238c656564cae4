#include "railcast/motion_sensors.h"

#include <algorithm>
#include <utility>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/motion/gnss.h"
#include "core/motion/imu.h"
#include "core/motion/odometer.h"
#include "core/motion/sample_times.h"
#include "core/simulate/frame_scene.h"

namespace railcast {
namespace {

struct TimeSpan {
  std::int64_t begin_ns{};
  std::int64_t end_ns{};
};

TimeSpan SpanOfFrame(const ScanPattern& pattern, std::uint32_t frame_index) {
  const std::int64_t begin_ns = pattern.StampNs(frame_index);
  if (frame_index == pattern.LastFrame()) return {begin_ns, begin_ns + pattern.PeriodNs()};
  return {begin_ns, pattern.StampNs(frame_index + 1)};
}

/// Calls `add(sample)` for the number of each sample in a span.
template <typename Add>
void ForEachSample(const TimeSpan& span, double rate_hz, const Add& add) {
  const SampleRange range = SamplesBetween(span.begin_ns, span.end_ns, rate_hz);
  for (std::uint64_t sample = range.begin; sample < range.end; ++sample) add(sample);
}

const RailWorld& WorldOf(const Simulator& simulator) {
  const auto* world = dynamic_cast<const RailWorld*>(&simulator.world());
  Check(world != nullptr, "motion sensors are on the vehicle of a railway");
  return *world;
}

}  // namespace

struct MotionSensors::Parts {
  MotionSensorsSpec spec;
  std::optional<MapSpec> map;
  std::vector<Transform> vehicle_from_imus;
  std::vector<ImuErrors> imu_errors;
  std::vector<std::uint64_t> gnss_seeds;
  std::optional<TrackOdometry> odometry;  ///< If there is an odometer.

  [[nodiscard]] std::vector<ImuSample> SampleImu(std::size_t imu,
                                                 const RailWorld& world,
                                                 const TimeSpan& span) const;
  [[nodiscard]] std::vector<GnssSample> SampleGnss(std::size_t receiver,
                                                   const RailWorld& world,
                                                   const SceneOfFrame& scene,
                                                   const TimeSpan& span,
                                                   double reach_m) const;
  [[nodiscard]] std::vector<OdometerSample> SampleOdometer(std::size_t odometer,
                                                           const RailWorld& world,
                                                           const TimeSpan& span) const;
};

std::vector<ImuSample> MotionSensors::Parts::SampleImu(std::size_t imu,
                                                       const RailWorld& world,
                                                       const TimeSpan& span) const {
  const double rate_hz = spec.imus[imu].rate_hz;
  std::vector<ImuSample> samples;
  ForEachSample(span, rate_hz, [&](std::uint64_t number) {
    const std::int64_t time_ns = SampleTimeNs(number, rate_hz);
    ImuSample& sample = samples.emplace_back(
        TrueImuSample(world.VehicleMotion(time_ns), vehicle_from_imus[imu], time_ns));
    const ImuErrors::Errors errors = imu_errors[imu].Of(number);
    sample.angular_velocity_radps =
        sample.true_angular_velocity_radps + errors.angular_velocity_radps;
    sample.specific_force_mps2 = sample.true_specific_force_mps2 + errors.specific_force_mps2;
  });
  return samples;
}

std::vector<GnssSample> MotionSensors::Parts::SampleGnss(std::size_t receiver,
                                                         const RailWorld& world,
                                                         const SceneOfFrame& scene,
                                                         const TimeSpan& span,
                                                         double reach_m) const {
  const GnssSpec& own = spec.gnss[receiver];
  const GnssReceiver measuring{own, gnss_seeds[receiver], map};
  std::vector<GnssSample> samples;
  ForEachSample(span, own.rate_hz, [&](std::uint64_t number) {
    const RigidMotion vehicle = world.VehicleMotion(SampleTimeNs(number, own.rate_hz));
    const double sky_share =
        FreeSkyShare(scene, vehicle.world_from_body * AntennaOf_m(own),
                     RadFromDeg(own.elevation_mask_deg), std::min(reach_m, kSkyReach_m));
    samples.push_back(measuring.Measure(vehicle, sky_share, number));
  });
  return samples;
}

std::vector<OdometerSample> MotionSensors::Parts::SampleOdometer(std::size_t odometer,
                                                                 const RailWorld& world,
                                                                 const TimeSpan& span) const {
  const OdometerSpec& own = spec.odometers[odometer];
  std::vector<OdometerSample> samples;
  ForEachSample(span, own.rate_hz, [&](std::uint64_t number) {
    samples.push_back(MeasureOdometer(own, *odometry, world, number));
  });
  return samples;
}

MotionSensors::MotionSensors(const MotionSensorsSpec& spec,
                             const std::vector<Transform>& vehicle_from_imus,
                             const RailWorld& world,
                             const std::optional<MapSpec>& map,
                             const std::function<std::uint64_t(const std::string& name)>& seed_of) {
  Check(vehicle_from_imus.size() == spec.imus.size(), "each IMU has a mount");
  auto parts = std::make_shared<Parts>();
  parts->spec = spec;
  parts->map = map;
  parts->vehicle_from_imus = vehicle_from_imus;
  for (const ImuSpec& imu : spec.imus) parts->imu_errors.emplace_back(imu, seed_of(imu.name));
  for (const GnssSpec& gnss : spec.gnss) parts->gnss_seeds.push_back(seed_of(gnss.name));
  if (!spec.odometers.empty()) parts->odometry.emplace(world);
  parts_ = std::move(parts);
}

const MotionSensorsSpec& MotionSensors::spec() const {
  return parts_->spec;
}

MotionSamples MotionSensors::Sample(Simulator& simulator, std::uint32_t frame_index) const {
  return Sample(simulator, *simulator.Begin(frame_index));
}

MotionSamples MotionSensors::Sample(Simulator& simulator, BegunFrame& begun) const {
  const TimeSpan span = SpanOfFrame(simulator.pattern(), begun.index);
  const RailWorld& world = WorldOf(simulator);
  MotionSamples samples;
  for (std::size_t i = 0; i < parts_->spec.imus.size(); ++i) {
    samples.imus.push_back(parts_->SampleImu(i, world, span));
  }
  for (std::size_t i = 0; i < parts_->spec.odometers.size(); ++i) {
    samples.odometers.push_back(parts_->SampleOdometer(i, world, span));
  }
  if (parts_->spec.gnss.empty()) return samples;
  const double reach_m = simulator.spec().detector.range_max_m;
  simulator.VisitScene(begun, [&](const SceneOfFrame& scene) {
    for (std::size_t i = 0; i < parts_->spec.gnss.size(); ++i) {
      samples.gnss.push_back(parts_->SampleGnss(i, world, scene, span, reach_m));
    }
  });
  return samples;
}

}  // namespace railcast
