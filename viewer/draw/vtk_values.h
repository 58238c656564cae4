#pragma once

#include <vtkActor.h>
#include <vtkMatrix4x4.h>

#include <array>

#include "railcast/transform.h"
#include "viewer/color/palette.h"

namespace railcast {

// Converts railcast values to those of VTK.

[[nodiscard]] inline std::array<double, 3> VtkColor(const Rgb& rgb) {
  return {rgb[0] / 255.0, rgb[1] / 255.0, rgb[2] / 255.0};
}

inline void SetMatrix(const Transform& transform, vtkMatrix4x4& matrix) {
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) {
      matrix.SetElement(row, column, transform.matrix()(row, column));
    }
  }
}

/// Blends translucent actors in the order in which they are drawn. VTK's own order-independent
/// blending takes two passes over all pixels in floating point: 50 ms a frame without a graphics
/// card.
inline void BlendInOrder(vtkActor& actor) {
  actor.ForceOpaqueOn();
}

}  // namespace railcast
