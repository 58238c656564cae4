#pragma once

#include <vtkMatrix4x4.h>

#include <array>

#include "core/base/transform.h"
#include "viewer/color/rgb.h"

namespace railcast {

// Our values as VTK takes them.

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

}  // namespace railcast
