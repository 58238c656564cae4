#include "analysis/fit/plane_trials.h"

#include <cmath>

#include "core/detect/beam_optics.h"

namespace railcast {
namespace {

constexpr double kReach_m = 0.5;
constexpr double kMinCosine = 0.05;

// Where a firing looks: its row and column know better than its point, which noise moves; NaN if
// neither does.
Vector3 DirectionOf(const Frame& frame,
                    std::size_t slot,
                    const Vector3& point_m,
                    const ScanTable* scan) {
  if (scan != nullptr && scan->rows == frame.rows && scan->columns == frame.columns) {
    const auto direction =
        scan->Direction(slot / frame.width(), slot % frame.width() / frame.returns);
    if (!std::isnan(direction[0])) return {direction[0], direction[1], direction[2]};
  }
  return point_m.normalized();
}

// How far beyond the plane a point lies along its own beam.
double Beyond_m(const KnownPlane& plane, const Vector3& point_m) {
  const double along = plane.normal.dot(point_m.normalized());
  return point_m.norm() - plane.normal.dot(plane.point_m) / along;
}

}  // namespace

double StretchOnPlane(const Vector3& normal,
                      double range_m,
                      const Vector3& direction,
                      const BeamSpec& beam) {
  const Vector3 h = Vector3::UnitZ().cross(direction).normalized();
  const Vector3 v = direction.cross(h);
  const double spread_m = range_m / std::abs(normal.dot(direction)) *
                          std::hypot(HorizontalSigma_rad(beam) * normal.dot(h),
                                     VerticalSigma_rad(beam) * normal.dot(v));
  const double pulse_m = PulseSigma_m(beam);
  return pulse_m / std::hypot(pulse_m, spread_m);
}

void ForEachPlaneTrial(const RecordedFrame& recorded,
                       const PlaneScene& scene,
                       const SensorFacts& facts,
                       const TrialTaker& take) {
  const Frame& frame = recorded.frame;
  for (std::size_t slot = 0; slot < frame.num_slots(); slot += frame.returns) {
    const Vector3 point_m =
        Eigen::Vector3f(frame.x[slot], frame.y[slot], frame.z[slot]).cast<double>();
    const Vector3 direction = DirectionOf(frame, slot, point_m, facts.scan);
    if (std::isnan(direction.x())) continue;
    const auto hit = HitPlanes(scene.planes, direction);
    if (!hit || hit->cos_incidence < kMinCosine) continue;
    if (hit->range_m < facts.range_min_m || hit->range_m > facts.range_max_m) continue;
    const KnownPlane& plane = scene.planes[hit->plane];
    Trial trial;
    trial.expected_m = static_cast<float>(hit->range_m);
    trial.cos_incidence = static_cast<float>(hit->cos_incidence);
    trial.stretch =
        static_cast<float>(StretchOnPlane(plane.normal, hit->range_m, direction, facts.beam));
    trial.slant =
        static_cast<float>(hit->range_m * std::sqrt(1.0 - hit->cos_incidence * hit->cos_incidence) /
                           hit->cos_incidence);
    trial.surface = scene.surfaces[hit->plane];
    trial.channel = frame.ring[slot];
    if (!std::isnan(point_m.x())) {
      const double beyond_m = Beyond_m(plane, point_m);
      trial.answer = std::abs(beyond_m) < kReach_m ? Answer::kReturned : Answer::kElsewhere;
      trial.residual_m =
          static_cast<float>(scene.is_isotropic ? beyond_m * hit->cos_incidence : beyond_m);
      trial.intensity = frame.intensity[slot];
    }
    take(trial, slot);
  }
}

}  // namespace railcast
