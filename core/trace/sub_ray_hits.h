// See core/detect/vector_math.h for why this header has no `#pragma once`.
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

/// Sub-rays that are tested together. NegativeLanes() collects as many.
constexpr std::size_t kRayGroup = kTreeWidth;

/// The sub-rays' directions in the frame of a model.
struct SubRayDirections {
  alignas(64) float x[kNumSubRays];
  alignas(64) float y[kNumSubRays];
  alignas(64) float z[kNumSubRays];
  // 1 / x and so on.
  alignas(64) float per_x[kNumSubRays];
  alignas(64) float per_y[kNumSubRays];
  alignas(64) float per_z[kNumSubRays];
};

inline void TurnSubRays(const Rows& model_from_window,
                        const BeamRays& beam,
                        SubRayDirections& turned) {
  const Rows r = model_from_window;
  const std::size_t num_rays = beam.num_rays;
  for (std::size_t i = 0; i < num_rays; ++i) {
    const float x = beam.direction_x[i];
    const float y = beam.direction_y[i];
    const float z = beam.direction_z[i];
    turned.x[i] = r.m[0] * x + r.m[1] * y + r.m[2] * z;
    turned.y[i] = r.m[4] * x + r.m[5] * y + r.m[6] * z;
    turned.z[i] = r.m[8] * x + r.m[9] * y + r.m[10] * z;
  }
  constexpr float kTiny = 1e-9F;
  const auto inverse = [](float d) { return 1.0F / (std::fabs(d) < kTiny ? kTiny : d); };
  for (std::size_t i = 0; i < num_rays; ++i) {
    turned.per_x[i] = inverse(turned.x[i]);
    turned.per_y[i] = inverse(turned.y[i]);
    turned.per_z[i] = inverse(turned.z[i]);
  }
}

/// Whether any sub-ray passes through the box of a node's child nearer than what it has hit.
[[nodiscard]] inline bool IsBoxMet(const BeamNode& node,
                                   std::size_t child,
                                   const float* origin,
                                   const SubRayDirections& rays,
                                   const BeamRays& beam) {
  const float xl = node.lower[0][child] - origin[0];
  const float xu = node.upper[0][child] - origin[0];
  const float yl = node.lower[1][child] - origin[1];
  const float yu = node.upper[1][child] - origin[1];
  const float zl = node.lower[2][child] - origin[2];
  const float zu = node.upper[2][child] - origin[2];
  constexpr float kNearer = 1.0F - kRoundingMargin;
  constexpr float kFarther = 1.0F + kRoundingMargin;
  for (std::size_t first = 0; first < beam.num_rays; first += kRayGroup) {
    alignas(64) float misses[kRayGroup];
    for (std::size_t k = 0; k < kRayGroup; ++k) {
      const std::size_t i = first + k;
      const float ax = xl * rays.per_x[i];
      const float bx = xu * rays.per_x[i];
      const float ay = yl * rays.per_y[i];
      const float by = yu * rays.per_y[i];
      const float az = zl * rays.per_z[i];
      const float bz = zu * rays.per_z[i];
      const float in = Most(Most(Least(ax, bx), Least(ay, by)), Most(Least(az, bz), 0.0F));
      const float out =
          Least(Least(Most(ax, bx), Most(ay, by)), Least(Most(az, bz), beam.range_m[i]));
      misses[k] = kNearer * in <= kFarther * out ? -1.0F : 1.0F;
    }
    if (NegativeLanes(misses) != 0) return true;
  }
  return false;
}

/// Intersects all sub-rays with the triangle in a lane of a leaf. Returns whether any hits it
/// nearer than anything before.
[[nodiscard]] inline bool HitTriangle(const LeafProducts& products,
                                      std::size_t lane,
                                      const SubRayDirections& rays,
                                      std::uint32_t facet,
                                      BeamRays& beam) {
  float e[3][3];
  float n[3];
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) e[k][i] = products.edge[k][i][lane];
    n[i] = products.normal[i][lane];
  }
  const float offset = products.offset[lane];
  bool is_any_hit = false;
  for (std::size_t first = 0; first < beam.num_rays; first += kRayGroup) {
    // A group that passes the triangle by, as most do, needs no division.
    alignas(64) float passes[kRayGroup];
    for (std::size_t k = 0; k < kRayGroup; ++k) {
      const float x = rays.x[first + k];
      const float y = rays.y[first + k];
      const float z = rays.z[first + k];
      const float u = e[0][0] * x + e[0][1] * y + e[0][2] * z;
      const float v = e[1][0] * x + e[1][1] * y + e[1][2] * z;
      const float w = e[2][0] * x + e[2][1] * y + e[2][2] * z;
      const bool is_inside = (Least(u, Least(v, w)) >= 0.0F) | (Most(u, Most(v, w)) <= 0.0F);
      passes[k] = is_inside ? -1.0F : 1.0F;
    }
    if (NegativeLanes(passes) == 0) continue;
    alignas(64) float hits[kRayGroup];
    for (std::size_t k = 0; k < kRayGroup; ++k) {
      const std::size_t i = first + k;
      const float t = offset / (n[0] * rays.x[i] + n[1] * rays.y[i] + n[2] * rays.z[i]);
      const float old = beam.range_m[i];
      const bool is_hit = (passes[k] < 0.0F) & (t > 0.0F) & (t < old);
      beam.range_m[i] = is_hit ? t : old;
      beam.facet[i] = is_hit ? facet : beam.facet[i];
      hits[k] = is_hit ? -1.0F : 1.0F;
    }
    is_any_hit |= NegativeLanes(hits) != 0;
  }
  return is_any_hit;
}

[[nodiscard]] inline float FarthestRange(const BeamRays& beam) {
  constexpr std::size_t kLanes = 8;
  float lanes[kLanes];
  for (std::size_t k = 0; k < kLanes; ++k) lanes[k] = beam.range_m[k];
  for (std::size_t i = kLanes; i < beam.num_rays; i += kLanes) {
    for (std::size_t k = 0; k < kLanes; ++k) lanes[k] = Most(lanes[k], beam.range_m[i + k]);
  }
  float farthest = lanes[0];
  for (std::size_t k = 1; k < kLanes; ++k) farthest = Most(farthest, lanes[k]);
  return farthest;
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
