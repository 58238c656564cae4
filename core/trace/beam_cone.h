// See core/detect/base/vector_math.h for why this header has no `#pragma once`.
#ifndef RAILCAST_TRACE_BEAM_CONE_H_
#define RAILCAST_TRACE_BEAM_CONE_H_

#include <cmath>
#include <cstddef>
#include <cstdint>
#ifdef __SSE__
#include <immintrin.h>
#endif

#include "core/trace/beam_tree.h"

#ifndef RAILCAST_ISA
#define RAILCAST_ISA baseline
#endif

/// A beam as a cone, and what of a tree it meets.
namespace railcast::RAILCAST_ISA {

[[nodiscard]] inline float Least(float a, float b) {
  return a < b ? a : b;
}
[[nodiscard]] inline float Most(float a, float b) {
  return a > b ? a : b;
}

/// Number of lanes that are masked together.
constexpr std::size_t kMaskLanes = 8;

/// Collects the lanes whose value is negative into a bit mask.
[[nodiscard]] inline std::uint32_t NegativeLanes(const float* lanes) {
#ifdef __AVX__
  return static_cast<std::uint32_t>(_mm256_movemask_ps(_mm256_load_ps(lanes)));
#elif defined(__SSE__)
  return static_cast<std::uint32_t>(_mm_movemask_ps(_mm_load_ps(lanes))) |
         static_cast<std::uint32_t>(_mm_movemask_ps(_mm_load_ps(lanes + 4))) << 4U;
#else
  std::uint32_t mask = 0;
  for (std::size_t i = 0; i < kMaskLanes; ++i) mask |= (lanes[i] < 0.0F ? 1U : 0U) << i;
  return mask;
#endif
}

/// The same of a node's children.
[[nodiscard]] inline std::uint32_t NegativeOfTree(const float* lanes) {
  return NegativeLanes(lanes) | NegativeLanes(lanes + kMaskLanes) << kMaskLanes;
}
static_assert(kTreeWidth == 2 * kMaskLanes && kLeafWidth == kMaskLanes);

/// A beam as a cone in the frame of a tree.
struct Cone {
  float origin[3], axis[3];
  float half_h[3], half_v[3];  ///< As BeamRays; scaled as `axis` is.
  float per_axis[3];           ///< 1 / axis.
  float spread[3];             ///< Half extent of the directions along x, y, z.
  float reach[3];              ///< The same per distance, with room for rounding.
  float inverse_norm;          ///< 1 / length of `axis`.
  float widening;              ///< See WidenStretchedCone().
};

/// Room for rounding, relative to a cone's half extent and to the distance.
constexpr float kConeMargin = 1.0005F;
constexpr float kRoundingMargin = 1e-6F;
constexpr float kNearer = 1.0F - kRoundingMargin;
constexpr float kFarther = 1.0F + kRoundingMargin;
/// In place of a slope of 0, which is a divisor.
constexpr float kLeastSlope = 1e-30F;

/// Completes a cone whose origin and directions are set.
inline void FinishCone(Cone& cone) {
  float length2 = 0.0F;
  for (int i = 0; i < 3; ++i) length2 += cone.axis[i] * cone.axis[i];
  cone.inverse_norm = 1.0F / std::sqrt(length2);
  cone.widening = 1.0F;
  for (int i = 0; i < 3; ++i) {
    constexpr float kTiny = 1e-9F;
    const float d = cone.axis[i];
    cone.per_axis[i] = 1.0F / (std::fabs(d) < kTiny ? (d < 0.0F ? -kTiny : kTiny) : d);
    const float half2 = cone.half_h[i] * cone.half_h[i] + cone.half_v[i] * cone.half_v[i];
    cone.spread[i] = std::sqrt(half2);
    cone.reach[i] = kConeMargin * cone.spread[i] * cone.inverse_norm + kRoundingMargin;
  }
}

/// Widens a cone in the frame of a stretched model. FinishCone() takes all directions of the cone
/// to be as long as its axis; here, some may be shorter by the extents of the cone.
inline void WidenStretchedCone(Cone& cone) {
  float axis2 = 0.0F;
  float half2 = 0.0F;
  for (int i = 0; i < 3; ++i) {
    axis2 += cone.axis[i] * cone.axis[i];
    half2 += cone.half_h[i] * cone.half_h[i] + cone.half_v[i] * cone.half_v[i];
  }
  const float axis = std::sqrt(axis2);
  const float shortest = axis - std::sqrt(half2);
  constexpr float kMostWidening = 1e6F;
  cone.widening = shortest * kMostWidening > axis ? axis / shortest : kMostWidening;
  for (float& reach : cone.reach) reach *= cone.widening;
}

/// Whether the cone may meet a box nearer than `far`.
[[nodiscard]] inline bool IsBoxMet(const BeamBox& box, const Cone& cone, float far) {
  float farthest2 = 0.0F;
  for (int i = 0; i < 3; ++i) {
    const float most =
        Most(std::fabs(box.lower[i] - cone.origin[i]), std::fabs(box.upper[i] - cone.origin[i]));
    farthest2 += most * most;
  }
  const float farthest = std::sqrt(farthest2);
  float in = 0.0F;
  float out = far;
  for (int i = 0; i < 3; ++i) {
    const float a = (box.lower[i] - cone.origin[i]) * cone.per_axis[i];
    const float b = (box.upper[i] - cone.origin[i]) * cone.per_axis[i];
    const float reach = farthest * cone.reach[i] * std::fabs(cone.per_axis[i]);
    in = Most(in, Least(a, b) - reach);
    out = Least(out, Most(a, b) + reach);
  }
  return in <= out;
}

/// A cone with each number once per lane, so that the loops below read whole vectors.
struct ConeLanes {
  alignas(64) float origin[3][kMaskLanes], axis[3][kMaskLanes];
  alignas(64) float half_h[3][kMaskLanes], half_v[3][kMaskLanes];
  alignas(64) float per_axis[3][kMaskLanes];
  alignas(64) float reach[3][kMaskLanes];  ///< Cone::reach times the magnitude of `per_axis`.
  std::size_t near[3];                     ///< The bound of a box that the cone meets first.
};

inline void FillLanes(const Cone& cone, ConeLanes& lanes) {
  for (std::size_t i = 0; i < 3; ++i) {
    const float reach = cone.reach[i] * std::fabs(cone.per_axis[i]);
    for (std::size_t k = 0; k < kMaskLanes; ++k) {
      lanes.origin[i][k] = cone.origin[i];
      lanes.axis[i][k] = cone.axis[i];
      lanes.half_h[i][k] = cone.half_h[i];
      lanes.half_v[i][k] = cone.half_v[i];
      lanes.per_axis[i][k] = cone.per_axis[i];
      lanes.reach[i][k] = reach;
    }
    lanes.near[i] = cone.per_axis[i] < 0.0F ? 1 : 0;
  }
}

/// Distances of a node's children.
struct ChildDistances {
  alignas(64) float entry[kTreeWidth];
  alignas(64) float farthest[kTreeWidth];
};

/// Returns the children among all of a node's places for them that the cone may meet nearer than
/// `far`, and the parameters along the axis at which it enters them, with the distances of their
/// farthest corners.
[[nodiscard]] inline std::uint32_t ChildrenMet(const BeamNode& node,
                                               const ConeLanes& c,
                                               float far,
                                               ChildDistances& distances) {
  alignas(64) float outside[kTreeWidth];
  const float(*const bounds[2])[kTreeWidth] = {node.lower, node.upper};
  const float* const near_x = bounds[c.near[0]][0];
  const float* const near_y = bounds[c.near[1]][1];
  const float* const near_z = bounds[c.near[2]][2];
  const float* const far_x = bounds[1 - c.near[0]][0];
  const float* const far_y = bounds[1 - c.near[1]][1];
  const float* const far_z = bounds[1 - c.near[2]][2];
  for (std::size_t half = 0; half < kTreeWidth; half += kMaskLanes) {
#ifndef __clang__
#pragma GCC ivdep
#endif
    for (std::size_t k = 0; k < kMaskLanes; ++k) {
      const float nx = near_x[half + k] - c.origin[0][k];
      const float ny = near_y[half + k] - c.origin[1][k];
      const float nz = near_z[half + k] - c.origin[2][k];
      const float fx = far_x[half + k] - c.origin[0][k];
      const float fy = far_y[half + k] - c.origin[1][k];
      const float fz = far_z[half + k] - c.origin[2][k];
      const float x = Most(std::fabs(nx), std::fabs(fx));
      const float y = Most(std::fabs(ny), std::fabs(fy));
      const float z = Most(std::fabs(nz), std::fabs(fz));
      const float farthest = std::sqrt(x * x + y * y + z * z);
      const float rx = farthest * c.reach[0][k];
      const float ry = farthest * c.reach[1][k];
      const float rz = farthest * c.reach[2][k];
      const float in = Most(Most(nx * c.per_axis[0][k] - rx, ny * c.per_axis[1][k] - ry),
                            Most(nz * c.per_axis[2][k] - rz, 0.0F));
      const float out = Least(Least(fx * c.per_axis[0][k] + rx, fy * c.per_axis[1][k] + ry),
                              Least(fz * c.per_axis[2][k] + rz, far));
      distances.entry[half + k] = in;
      distances.farthest[half + k] = farthest;
      outside[half + k] = in <= out ? -1.0F : 1.0F;
    }
  }
  return NegativeOfTree(outside);
}

/// What the test of a ray needs of a leaf's triangles, by lane. A ray from the cone's origin along
/// axis + a half_h + b half_v passes through a triangle if its products with the three edges'
/// moments have one sign, and meets its plane at offset / (its product with the normal) (Plücker
/// coordinates; Embree's robust test). All four products are linear in a and b. Seen from the
/// origin, a triangle's edges run one way round or the other, as the sign of `offset` says; those
/// of the edges are turned such that rays that pass through it have positive ones.
struct LeafProducts {
  /// By edge; the last is the normal.
  alignas(64) float along[4][kLeafWidth], h[4][kLeafWidth], v[4][kLeafWidth];
  alignas(64) float normal[3][kLeafWidth];
  alignas(64) float offset[kLeafWidth];
  alignas(64) float nearest[kLeafWidth];  ///< The least range at which the cone can meet the plane.
};

/// Fills the products and returns those of all lanes that the cone may meet nearer than `far`.
// NOLINTNEXTLINE(readability-function-size): its values stay in registers
[[nodiscard]] inline std::uint32_t TrianglesMet(const BeamLeaf& leaf,
                                                const ConeLanes& c,
                                                float far,
                                                LeafProducts& products) {
  alignas(64) float met[kLeafWidth];
#ifndef __clang__
#pragma GCC ivdep
#endif
  for (std::size_t k = 0; k < kLeafWidth; ++k) {
    float v[3][3];
    for (int corner = 0; corner < 3; ++corner) {
      for (int i = 0; i < 3; ++i) v[corner][i] = leaf.corner[corner][i][k] - c.origin[i][k];
    }
    const float px = v[1][0] - v[0][0];
    const float py = v[1][1] - v[0][1];
    const float pz = v[1][2] - v[0][2];
    const float qx = v[2][0] - v[0][0];
    const float qy = v[2][1] - v[0][1];
    const float qz = v[2][2] - v[0][2];
    const float nx = py * qz - pz * qy;
    const float ny = pz * qx - px * qz;
    const float nz = px * qy - py * qx;
    const float offset = v[0][0] * nx + v[0][1] * ny + v[0][2] * nz;
    const float way_round = std::copysign(1.0F, -offset);
    bool may_be_left = true;
    bool may_be_right = true;
    for (int e = 0; e < 3; ++e) {
      const float* const a = v[e];
      const float* const b = v[(e + 1) % 3];
      const float dx = b[0] - a[0];
      const float dy = b[1] - a[1];
      const float dz = b[2] - a[2];
      const float sx = b[0] + a[0];
      const float sy = b[1] + a[1];
      const float sz = b[2] + a[2];
      const float mx = dy * sz - dz * sy;
      const float my = dz * sx - dx * sz;
      const float mz = dx * sy - dy * sx;
      const float ax = c.axis[0][k] * mx;
      const float ay = c.axis[1][k] * my;
      const float az = c.axis[2][k] * mz;
      const float along = ax + ay + az;
      const float h = c.half_h[0][k] * mx + c.half_h[1][k] * my + c.half_h[2][k] * mz;
      const float w = c.half_v[0][k] * mx + c.half_v[1][k] * my + c.half_v[2][k] * mz;
      const float reach = kConeMargin * std::sqrt(h * h + w * w) +
                          kRoundingMargin * (std::fabs(ax) + std::fabs(ay) + std::fabs(az));
      products.along[e][k] = way_round * along;
      products.h[e][k] = way_round * h;
      products.v[e][k] = way_round * w;
      may_be_left = may_be_left & (along >= -reach);
      may_be_right = may_be_right & (along <= reach);
    }
    const float along = c.axis[0][k] * nx + c.axis[1][k] * ny + c.axis[2][k] * nz;
    const float h = c.half_h[0][k] * nx + c.half_h[1][k] * ny + c.half_h[2][k] * nz;
    const float w = c.half_v[0][k] * nx + c.half_v[1][k] * ny + c.half_v[2][k] * nz;
    const float steepest = std::fabs(along) + std::sqrt(h * h + w * w);
    const float nearest = std::fabs(offset) / Most(steepest, kLeastSlope);
    products.nearest[k] = nearest;
    products.normal[0][k] = nx;
    products.normal[1][k] = ny;
    products.normal[2][k] = nz;
    products.offset[k] = offset;
    products.along[3][k] = along;
    products.h[3][k] = h;
    products.v[3][k] = w;
    const bool may_be_met = (may_be_left | may_be_right) & (kNearer * nearest <= far);
    met[k] = may_be_met ? -1.0F : 1.0F;
  }
  return NegativeLanes(met);
}

}  // namespace railcast::RAILCAST_ISA

#endif  // RAILCAST_TRACE_BEAM_CONE_H_
