#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/mesh/polygon_soup.h"

namespace railcast {

/// Red, green and blue.
using Rgb8 = std::array<std::uint8_t, 3>;

/// The luminance of a linear colour as sRGB (IEC 61966-2-1) has it: 1 = white.
[[nodiscard]] constexpr double LuminanceOf(double red, double green, double blue) {
  return 0.2126 * red + 0.7152 * green + 0.0722 * blue;
}

/// Gives each face without a material's name that of its first corner's colour, like "#a0522d". If
/// there are more than 32 such colours, the mesh is a photograph rather than painted, and nothing
/// is changed.
/// @param of_points A colour for each of the soup's points; may be empty.
void NameMaterialsByColor(const std::vector<Rgb8>& of_points, PolygonSoup& soup);

}  // namespace railcast
