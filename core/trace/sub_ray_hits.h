// See core/detect/base/vector_math.h for why this header has no `#pragma once`.
#ifndef RAILCAST_TRACE_SUB_RAY_HITS_H_
#define RAILCAST_TRACE_SUB_RAY_HITS_H_

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "core/trace/beam_cone.h"
#include "core/trace/beam_tree.h"
#include "railcast/ray_caster.h"

#ifndef RAILCAST_ISA
#define RAILCAST_ISA baseline
#endif

/// Sub-rays of a beam against boxes and triangles.
namespace railcast::RAILCAST_ISA {

/// Sub-rays that are tested together.
constexpr std::size_t kRayLanes = kMaskLanes;
static_assert(kNumCrowdedSubRays % kRayLanes == 0 && kNumSubRays % kRayLanes == 0);

/// The sub-rays by their places in the beam's cross-section, which are the same in the frame of
/// every model: a ray's direction is (axis + a half_h + b half_v) / norm.
struct SubRayPlaces {
  alignas(64) float a[kNumCloserSubRays], b[kNumCloserSubRays];
  alignas(64) float norm[kNumCloserSubRays];
  bool are_known = false;  ///< Whether they are set, which most beams do not need.
  /// In units of so much of the beam's semi-axes.
  float part = 1.0F;
};

/// Returns the farthest range among the sub-rays.
[[nodiscard]] inline float FindFarthest(const BeamRays& beam) {
  float far[kRayLanes];
  for (std::size_t k = 0; k < kRayLanes; ++k) far[k] = beam.range_m[k];
  for (std::size_t first = kRayLanes; first < beam.num_rays; first += kRayLanes) {
    for (std::size_t k = 0; k < kRayLanes; ++k) far[k] = Most(far[k], beam.range_m[first + k]);
  }
  for (std::size_t half = kRayLanes / 2; half > 0; half /= 2) {
    for (std::size_t k = 0; k < half; ++k) far[k] = Most(far[k], far[k + half]);
  }
  return far[0];
}

inline void PlaceSubRays(const BeamRays& beam, SubRayPlaces& places) {
  float h2 = 0.0F;
  float v2 = 0.0F;
  for (int i = 0; i < 3; ++i) {
    h2 += beam.half_h[i] * beam.half_h[i];
    v2 += beam.half_v[i] * beam.half_v[i];
  }
  const float per_h2 = h2 > 0.0F ? 1.0F / h2 : 0.0F;
  const float per_v2 = v2 > 0.0F ? 1.0F / v2 : 0.0F;
  const float axis[3] = {beam.axis[0], beam.axis[1], beam.axis[2]};
  const float h[3] = {beam.half_h[0] * per_h2, beam.half_h[1] * per_h2, beam.half_h[2] * per_h2};
  const float v[3] = {beam.half_v[0] * per_v2, beam.half_v[1] * per_v2, beam.half_v[2] * per_v2};
  for (std::size_t i = 0; i < beam.num_rays; ++i) {
    const float x = beam.direction_x[i];
    const float y = beam.direction_y[i];
    const float z = beam.direction_z[i];
    // The products of the short difference to the axis lose less than those of the direction.
    const float dx = x - axis[0];
    const float dy = y - axis[1];
    const float dz = z - axis[2];
    const float norm = 1.0F / (x * axis[0] + y * axis[1] + z * axis[2]);
    places.a[i] = (dx * h[0] + dy * h[1] + dz * h[2]) * norm;
    places.b[i] = (dx * v[0] + dy * v[1] + dz * v[2]) * norm;
    places.norm[i] = norm;
  }
  places.are_known = true;
}

/// Narrows the beam to the sub-rays of a crowd.
/// @pre The places are known.
inline void NarrowToCrowd(SubRayPlaces& places) {
  float largest2 = 0.0F;
  for (std::size_t i = 0; i < kNumCrowdedSubRays; ++i) {
    largest2 = Most(largest2, places.a[i] * places.a[i] + places.b[i] * places.b[i]);
  }
  const float part = Least(kConeMargin * std::sqrt(largest2), 1.0F);
  const float per_part = 1.0F / part;
  for (std::size_t i = 0; i < kNumCrowdedSubRays; ++i) {
    places.a[i] *= per_part;
    places.b[i] *= per_part;
  }
  places.part *= part;
}

/// The sub-rays of a crowd in the frame of a tree.
struct Probes {
  alignas(64) float per_axis[3][kNumCrowdedSubRays];
};

inline void AimProbes(const Cone& cone, const SubRayPlaces& places, Probes& probes) {
  constexpr float kTiny = 1e-9F;
  for (int i = 0; i < 3; ++i) {
    const float axis = cone.axis[i];
    const float h = cone.half_h[i];
    const float v = cone.half_v[i];
    for (std::size_t k = 0; k < kNumCrowdedSubRays; ++k) {
      const float d = axis + places.a[k] * h + places.b[k] * v;
      probes.per_axis[i][k] = 1.0F / (std::fabs(d) < kTiny ? kTiny : d);
    }
  }
}

/// Whether any sub-ray of a crowd may pass through the box of a node's child nearer than what it
/// has hit.
/// @param margin_m Room for rounding.
// NOLINTNEXTLINE(readability-function-size): its values stay in registers
[[nodiscard]] inline bool IsBoxMet(const BeamNode& node,
                                   std::size_t child,
                                   const float* origin,
                                   float margin_m,
                                   const Probes& probes,
                                   const float* range_m) {
  const float xl = node.lower[0][child] - origin[0] - margin_m;
  const float xu = node.upper[0][child] - origin[0] + margin_m;
  const float yl = node.lower[1][child] - origin[1] - margin_m;
  const float yu = node.upper[1][child] - origin[1] + margin_m;
  const float zl = node.lower[2][child] - origin[2] - margin_m;
  const float zu = node.upper[2][child] - origin[2] + margin_m;
  std::uint32_t met = 0;
  for (std::size_t first = 0; first < kNumCrowdedSubRays; first += kRayLanes) {
    alignas(64) float misses[kRayLanes];
    for (std::size_t k = 0; k < kRayLanes; ++k) {
      const std::size_t i = first + k;
      const float ax = xl * probes.per_axis[0][i];
      const float bx = xu * probes.per_axis[0][i];
      const float ay = yl * probes.per_axis[1][i];
      const float by = yu * probes.per_axis[1][i];
      const float az = zl * probes.per_axis[2][i];
      const float bz = zu * probes.per_axis[2][i];
      const float in = Most(Most(Least(ax, bx), Least(ay, by)), Most(Least(az, bz), 0.0F));
      const float out = Least(Least(Most(ax, bx), Most(ay, by)), Least(Most(az, bz), range_m[i]));
      misses[k] = kNearer * in <= kFarther * out ? -1.0F : 1.0F;
    }
    met |= NegativeLanes(misses);
  }
  return met != 0;
}

/// Which of `num` sub-rays from `begin` on pass through the triangle in a lane of a leaf, as a bit
/// mask.
template <std::size_t num>
[[nodiscard]] inline std::uint64_t RaysInside(const LeafProducts& t,
                                              std::size_t lane,
                                              const SubRayPlaces& places,
                                              std::size_t begin) {
  std::uint64_t outside = 0;
  for (std::size_t first = 0; first < num; first += kRayLanes) {
    alignas(64) float least[kRayLanes];
    for (std::size_t k = 0; k < kRayLanes; ++k) {
      const float a = places.a[begin + first + k];
      const float b = places.b[begin + first + k];
      const float u = t.along[0][lane] + a * t.h[0][lane] + b * t.v[0][lane];
      const float v = t.along[1][lane] + a * t.h[1][lane] + b * t.v[1][lane];
      const float w = t.along[2][lane] + a * t.h[2][lane] + b * t.v[2][lane];
      least[k] = Least(u, Least(v, w)) + 0.0F;  // -0 becomes 0, which is inside.
    }
    outside |= std::uint64_t{NegativeLanes(least)} << first;
  }
  return ~outside & (~std::uint64_t{0} >> (kNumSubRays - num));
}

/// Intersects the sub-rays from `first` on with a triangle. Returns whether any hits it nearer than
/// anything before.
// NOLINTNEXTLINE(readability-function-size): its values stay in registers
[[nodiscard]] inline bool HitLanes(const LeafProducts& t,
                                   std::size_t lane,
                                   std::size_t first,
                                   std::uint32_t facet,
                                   const SubRayPlaces& places,
                                   BeamRays& beam) {
  alignas(64) float hits[kRayLanes];
  // The places alias nothing of the beam. Clang finds out by itself.
#ifndef __clang__
#pragma GCC ivdep
#endif
  for (std::size_t k = 0; k < kRayLanes; ++k) {
    const std::size_t i = first + k;
    const float a = places.a[i];
    const float b = places.b[i];
    const float u = t.along[0][lane] + a * t.h[0][lane] + b * t.v[0][lane];
    const float v = t.along[1][lane] + a * t.h[1][lane] + b * t.v[1][lane];
    const float w = t.along[2][lane] + a * t.h[2][lane] + b * t.v[2][lane];
    const bool is_inside = Least(u, Least(v, w)) >= 0.0F;
    const float slope = t.along[3][lane] + a * t.h[3][lane] + b * t.v[3][lane];
    const float range_m = t.offset[lane] * places.norm[i] / slope;
    const float old = beam.range_m[i];
    const bool is_hit = is_inside & (range_m > 0.0F) & (range_m < old);
    beam.range_m[i] = is_hit ? range_m : old;
    beam.facet[i] = is_hit ? facet : beam.facet[i];
    hits[k] = is_hit ? -1.0F : 1.0F;
  }
  return NegativeLanes(hits) != 0;
}

/// Intersects the sub-rays that pass through the triangle in a lane of a leaf, a bit each from
/// `begin` on, with its plane. Returns whether any hits it nearer than anything before.
// NOLINTNEXTLINE(readability-function-size): its values stay in registers
[[nodiscard]] inline bool HitTriangle(const LeafProducts& products,
                                      std::size_t lane,
                                      std::uint64_t rays,
                                      std::size_t begin,
                                      const SubRayPlaces& places,
                                      BeamRays& beam) {
  bool is_any_hit = false;
  // Most triangles are met by few rays; only these need divisions.
  while (rays != 0) {
    const auto ray = static_cast<std::size_t>(__builtin_ctzll(rays));
    const std::size_t first = ray / kRayLanes * kRayLanes;
    rays &= ~(((std::uint64_t{1} << kRayLanes) - 1U) << first);
    is_any_hit |= HitLanes(products, lane, begin + first, beam.num_facets, places, beam);
  }
  return is_any_hit;
}

/// Drops the facets that no sub-ray is left on.
inline void DropHiddenFacets(BeamRays& beam) {
  std::uint32_t place[BeamRays::kMaxFacets];
  for (std::uint32_t f = 0; f < beam.num_facets; ++f) place[f] = 0;
  for (std::size_t i = 0; i < beam.num_rays; ++i) place[beam.facet[i]] = 1;
  std::uint32_t num_kept = 1;
  for (std::uint32_t f = 1; f < beam.num_facets; ++f) {
    if (place[f] == 0) continue;
    beam.facets[num_kept] = beam.facets[f];
    place[f] = num_kept++;
  }
  place[0] = 0;
  for (std::size_t i = 0; i < beam.num_rays; ++i) beam.facet[i] = place[beam.facet[i]];
  beam.num_facets = num_kept;
}

}  // namespace railcast::RAILCAST_ISA

#endif  // RAILCAST_TRACE_SUB_RAY_HITS_H_
