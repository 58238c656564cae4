#include "core/simulate/beams_near_objects.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "core/base/units.h"
#include "core/detect/base/beam_optics.h"
#include "core/detect/beam/footprint.h"
#include "core/detect/beam/sub_ray_pattern.h"
#include "core/scan/firing.h"

namespace railcast {
namespace {

// Between so near instants things move straight on, within kStraightness_m.
constexpr std::uint32_t kStep_ns = 5'000'000;
constexpr double kStraightness_m = 0.02;

MovingSphere SphereOf(const World& world,
                      std::size_t object,
                      const BeamReach& reach,
                      std::uint32_t duration_ns) {
  const Eigen::AlignedBox3d box_m = world.objects()[object].model->Bounds();
  MovingSphere sphere{.radius_m = 0.5 * box_m.diagonal().norm() + kStraightness_m};
  for (std::uint32_t step = 0; step <= duration_ns / kStep_ns + 1; ++step) {
    const std::int64_t time_ns = reach.stamp_ns + std::int64_t{step} * kStep_ns;
    const Transform world_from_sensor = world.WorldFromVehicle(time_ns) * reach.vehicle_from_sensor;
    sphere.centers_m.push_back(world_from_sensor.inverse() *
                               (world.WorldFromObject(object, time_ns) * box_m.center()).eval());
  }
  return sphere;
}

bool MeetsSphere(const MovingSphere& sphere,
                 const Vector3& origin_m,
                 const Vector3& direction,
                 std::uint32_t time_ns,
                 double beside_rad) {
  const std::size_t step = time_ns / kStep_ns;
  const double part = static_cast<double>(time_ns % kStep_ns) / kStep_ns;
  const Vector3 to_center_m = sphere.centers_m[step] +
                              part * (sphere.centers_m[step + 1] - sphere.centers_m[step]) -
                              origin_m;
  const double along_m = to_center_m.dot(direction);
  const double distance2_m2 = to_center_m.squaredNorm();
  const double reach_m = sphere.radius_m + beside_rad * std::sqrt(distance2_m2);
  return along_m > -reach_m && distance2_m2 - along_m * along_m < reach_m * reach_m;
}

}  // namespace

double BesideBeam_rad(const DetectorSpec& detector) {
  // Draws lie within so many standard deviations.
  constexpr double kMostDeviation = 6.0;
  double beside_rad = 0.0;
  if (HasFootprint(detector)) {
    // In a dense pattern, the outermost of n sub-rays is at sqrt(2 ln 2n) standard deviations.
    const double offset = std::max(
        static_cast<double>(SubRaysOfBeam().largest_offset),
        std::sqrt(2.0 * std::log(2.0 * static_cast<double>(detector.beam.reference_rays))));
    beside_rad +=
        offset * std::max(HorizontalSigma_rad(detector.beam), VerticalSigma_rad(detector.beam));
  }
  if (detector.effects.pointing_jitter) {
    beside_rad += kMostDeviation * RadFromDeg(detector.receiver.pointing_jitter_deg);
  }
  return 1.1 * beside_rad + 1e-4;
}

NearObjects::NearObjects(const World& world,
                         std::span<const std::size_t> objects,
                         const ScanPattern& pattern,
                         const BeamReach& reach)
    : pattern_(pattern) {
  if (pattern.num_firings() == 0) return;
  const std::uint32_t duration_ns = *std::ranges::max_element(pattern.time_ns);
  for (const std::size_t object : objects) {
    if (world.objects()[object].is_ego) continue;
    MovingSphere sphere = SphereOf(world, object, reach, duration_ns);
    const bool is_far = std::ranges::all_of(sphere.centers_m, [&](const Vector3& center_m) {
      return center_m.norm() > reach.range_max_m + sphere.radius_m + 1.0;
    });
    if (!is_far) spheres_.push_back(std::move(sphere));
  }
}

bool NearObjects::MayMeet(std::size_t firing, double beside_rad) const {
  const Vector3 direction = BeamDirection(pattern_, firing);
  const Vector3 origin_m = BeamOrigin_m(pattern_, firing);
  return std::ranges::any_of(spheres_, [&](const MovingSphere& sphere) {
    return MeetsSphere(sphere, origin_m, direction, pattern_.time_ns[firing], beside_rad);
  });
}

std::vector<std::uint32_t> NearObjects::Beams(
    double beside_rad, std::optional<std::span<const std::uint32_t>> among) const {
  std::vector<std::uint32_t> firings;
  if (spheres_.empty()) return firings;
  const auto add = [&](std::uint32_t firing) {
    if (MayMeet(firing, beside_rad)) firings.push_back(firing);
  };
  if (among) {
    std::ranges::for_each(*among, add);
  } else {
    for (std::uint32_t i = 0; i < pattern_.num_firings(); ++i) add(i);
  }
  return firings;
}

}  // namespace railcast
