#include "core/motion/gnss.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "core/camera/wires_in_pixels.h"
#include "core/motion/markov_sequence.h"
#include "core/motion/sample_times.h"
#include "core/rail/line/map_place.h"
#include "railcast/ray_caster.h"

namespace railcast {
namespace {

/// The directions are those of a Fibonacci lattice: equal steps in height, and a turn by the golden
/// angle from one to the next. They keep to the world's axes.
Vector3 SkyDirection(std::size_t ray, double elevation_mask_rad) {
  const double golden_angle_rad = std::numbers::pi * (3.0 - std::sqrt(5.0));
  const double share = (static_cast<double>(ray) + 0.5) / static_cast<double>(kTileSize);
  const double up = std::lerp(std::sin(elevation_mask_rad), 1.0, share);
  const double aside = std::sqrt(std::max(0.0, 1.0 - up * up));
  const double turn_rad = golden_angle_rad * static_cast<double>(ray);
  return {aside * std::cos(turn_rad), aside * std::sin(turn_rad), up};
}

/// Puts the rays behind surfaces of the vehicle itself.
/// @return Whether there was any.
bool PassThroughVehicle(const SceneOfFrame& scene, double range_m, RayTile& rays) {
  constexpr float kBehind_m = 1e-3F;
  bool was_any = false;
  for (std::size_t i = 0; i < rays.num_rays; ++i) {
    const bool is_ego = scene.surfaces[rays.surface[i]].is_ego;
    const float moved_m = is_ego ? rays.range_m[i] + kBehind_m : 0.0F;
    rays.origin_x[i] += moved_m * rays.direction_x[i];
    rays.origin_y[i] += moved_m * rays.direction_y[i];
    rays.origin_z[i] += moved_m * rays.direction_z[i];
    if (!is_ego) continue;
    was_any = true;
    rays.range_m[i] = static_cast<float>(range_m);
    rays.surface[i] = 0;
  }
  return was_any;
}

}  // namespace

double FreeSkyShare(const SceneOfFrame& scene,
                    const Vector3& place_world_m,
                    double elevation_mask_rad,
                    double range_m) {
  RayTile rays{};
  rays.num_rays = kTileSize;
  rays.mask = kAllButWires;
  const Vector3 place_m = scene.window_from_world * place_world_m;
  for (std::size_t i = 0; i < kTileSize; ++i) {
    const Vector3 direction =
        scene.window_from_world.linear() * SkyDirection(i, elevation_mask_rad);
    PutRay(place_m.cast<float>(), direction.cast<float>(), static_cast<float>(range_m), i, rays);
  }
  // A ray may meet several surfaces of the vehicle: the walls of a box in which the antenna is.
  constexpr int kMostSurfaces = 16;
  for (int pass = 0; pass < kMostSurfaces; ++pass) {
    scene.caster.Cast(rays);
    if (!PassThroughVehicle(scene, range_m, rays)) break;
  }
  const auto num_free = std::count(rays.surface, rays.surface + kTileSize, 0U);
  return static_cast<double>(num_free) / static_cast<double>(kTileSize);
}

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
