// See vector_math.h for why this header has no `#pragma once`.
#ifndef RAILCAST_DETECT_BEAM_AXES_H_
#define RAILCAST_DETECT_BEAM_AXES_H_

#include <cmath>

#include "core/detect/base/effect_parameters.h"
#include "core/detect/base/vector_math.h"

namespace railcast::RAILCAST_ISA {

struct Direction {
  float x, y, z;
};

/// A beam's horizontal axis, up x d, and its vertical axis, d x (up x d). Both have the length
/// whose square is `length2`. The axes of a beam along `up` are 0; a tiny amount added to `length2`
/// avoids a division by zero.
struct BeamAxes {
  Direction h, v;
  float length2;
};

[[nodiscard]] inline BeamAxes AxesOf(const Direction& d, const BeamFrame& beam) {
  const float hx = beam.up[1] * d.z - beam.up[2] * d.y;
  const float hy = beam.up[2] * d.x - beam.up[0] * d.z;
  const float hz = beam.up[0] * d.y - beam.up[1] * d.x;
  return {{hx, hy, hz},
          {d.y * hz - d.z * hy, d.z * hx - d.x * hz, d.x * hy - d.y * hx},
          hx * hx + hy * hy + hz * hz + 1e-20F};
}

/// Length of the axes. Small angles divided by it are the coordinates that Beside() expects.
[[nodiscard]] inline float LengthOf(const BeamAxes& axes) {
  return std::sqrt(axes.length2);
}

/// The unit direction at the offsets h and v from d along the axes: small angles in radians divided
/// by LengthOf(axes).
[[nodiscard]] inline Direction Beside(const Direction& d, const BeamAxes& axes, float h, float v) {
  const float x = d.x + h * axes.h.x + v * axes.v.x;
  const float y = d.y + h * axes.h.y + v * axes.v.y;
  const float z = d.z + h * axes.h.z + v * axes.v.z;
  const float per_norm = 1.0F / std::sqrt(x * x + y * y + z * z);
  return {x * per_norm, y * per_norm, z * per_norm};
}

}  // namespace railcast::RAILCAST_ISA

#endif  // RAILCAST_DETECT_BEAM_AXES_H_
