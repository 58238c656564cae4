#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

#include "core/detect/beam/wire_in_beam.h"

namespace railcast {

/// A beam from the origin towards a point, with the sensor's z axis up.
[[nodiscard]] inline WideBeam BeamTowards(const Vector3& target_m,
                                          double sigma_horizontal_rad,
                                          double sigma_vertical_rad) {
  WideBeam beam{.origin_m = Vector3::Zero(),
                .direction = target_m.normalized(),
                .horizontal = {},
                .vertical = {},
                .sigma_horizontal_rad = sigma_horizontal_rad,
                .sigma_vertical_rad = sigma_vertical_rad};
  beam.horizontal = Vector3::UnitZ().cross(beam.direction).normalized();
  beam.vertical = beam.direction.cross(beam.horizontal);
  return beam;
}

[[nodiscard]] inline WireSegment MakeWire(const Vector3& begin_m,
                                          const Vector3& end_m,
                                          double radius_m) {
  return {begin_m.cast<float>(), end_m.cast<float>(), static_cast<float>(radius_m), 1};
}

/// The point where a ray enters the side of a cylinder, and the cosine around its section there.
struct CylinderHit {
  double range_m{};
  double section_cosine{};
};

/// Solves |p - (p . axis) axis| = radius for p = origin + t direction, a quadratic equation in t.
[[nodiscard]] inline std::optional<CylinderHit> HitCylinder(const Vector3& origin_m,
                                                            const Vector3& direction,
                                                            const WireSegment& wire) {
  const Vector3 begin_m = wire.begin_m.cast<double>();
  const Vector3 run_m = wire.end_m.cast<double>() - begin_m;
  const Vector3 axis = run_m.normalized();
  const Vector3 from_begin_m = origin_m - begin_m;
  const Vector3 p_m = from_begin_m - from_begin_m.dot(axis) * axis;
  const Vector3 d = direction - direction.dot(axis) * axis;
  const double radius_m = static_cast<double>(wire.radius_m);
  const double a = d.squaredNorm();
  const double b = p_m.dot(d);
  const double discriminant = b * b - a * (p_m.squaredNorm() - radius_m * radius_m);
  if (!(discriminant >= 0.0) || a == 0.0) return std::nullopt;
  const double range_m = (-b - std::sqrt(discriminant)) / a;
  const double along_m = (from_begin_m + range_m * direction).dot(axis);
  if (range_m <= 0.0 || along_m < 0.0 || along_m > run_m.norm()) return std::nullopt;
  const Vector3 normal = (p_m + range_m * d) / radius_m;
  return CylinderHit{range_m, -normal.dot(d) / std::sqrt(a)};
}

/// The part of the exact cylinder that a beam of many random rays meets.
struct WireSamples {
  double share{}, range_m{}, spread_m{};
  double num_hits{};
};

[[nodiscard]] inline WireSamples SampleWire(const WideBeam& beam,
                                            const WireSegment& wire,
                                            int num_samples) {
  std::mt19937_64 engine(7);
  std::normal_distribution<double> normal;
  double weight = 0.0, first = 0.0, second = 0.0, num_hits = 0.0;
  for (int i = 0; i < num_samples; ++i) {
    const double x = beam.sigma_horizontal_rad * normal(engine);
    const double y = beam.sigma_vertical_rad * normal(engine);
    const Vector3 ray = (beam.direction + x * beam.horizontal + y * beam.vertical).normalized();
    const auto hit = HitCylinder(beam.origin_m, ray, wire);
    if (!hit) continue;
    num_hits += 1.0;
    weight += hit->section_cosine;
    first += hit->section_cosine * hit->range_m;
    second += hit->section_cosine * hit->range_m * hit->range_m;
  }
  const double mean_m = weight > 0.0 ? first / weight : 0.0;
  const double variance_m2 = weight > 0.0 ? second / weight - mean_m * mean_m : 0.0;
  return {num_hits / num_samples, mean_m, std::sqrt(std::max(0.0, variance_m2)), num_hits};
}

}  // namespace railcast
