#include "core/motion/gnss.h"

#include <cmath>

#include "core/motion/markov_sequence.h"
#include "core/motion/sample_times.h"
#include "core/rail/line/map_place.h"

namespace railcast {

Vector3 AntennaOf_m(const GnssSpec& spec) {
  return {spec.antenna_m[0], spec.antenna_m[1], spec.antenna_m[2]};
}

GnssSample GnssReceiver::Measure(const RigidMotion& vehicle,
                                 double sky_share,
                                 std::uint64_t sample) const {
  GnssSample measured;
  measured.time_ns = SampleTimeNs(sample, spec.rate_hz);
  measured.sky_share = sky_share;
  measured.true_position_m = vehicle.world_from_body * AntennaOf_m(spec);
  measured.true_velocity_mps = vehicle.VelocityOf_mps(AntennaOf_m(spec));
  measured.has_fix = sky_share > 0.0 && sky_share >= spec.least_sky_share;
  if (!measured.has_fix) return measured;
  const double growth = 1.0 / std::sqrt(sky_share);
  measured.position_sigma_m =
      growth * Vector3(spec.horizontal_noise_m, spec.horizontal_noise_m, spec.vertical_noise_m);
  measured.velocity_sigma_mps = growth * spec.velocity_noise_mps;
  const double decay_per_step = 1.0 / (spec.rate_hz * spec.correlation_time_s);
  for (std::uint32_t axis = 0; axis < 3; ++axis) {
    const SequenceKey key{seed, axis};
    measured.position_m(axis) = measured.true_position_m(axis) +
                                measured.position_sigma_m(axis) *
                                    MarkovSequence::Stationary(key, decay_per_step).At(sample);
    measured.velocity_mps(axis) =
        measured.true_velocity_mps(axis) + measured.velocity_sigma_mps * WhiteNoise(key, sample);
  }
  if (!map) return measured;
  const Eigen::Vector2d there_deg = GeographicFromWorld(*map, measured.position_m.head<2>());
  measured.longitude_deg = there_deg.x();
  measured.latitude_deg = there_deg.y();
  return measured;
}

}  // namespace railcast
