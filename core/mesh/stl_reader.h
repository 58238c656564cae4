#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "core/mesh/polygon_soup.h"

namespace railcast {

/// Lengths in binary STL files.
inline constexpr std::size_t kStlHeaderBytes = 84;
inline constexpr std::size_t kStlTriangleBytes = 50;

/// Reads STL files held in `bytes`. Corners at one place are one point in binary files.
///
/// It is railcast's own because OpenMesh passes over text whose lines it does not expect; a
/// binary file is a list of triangles.
/// @param shown Name of the file in error messages.
/// @throws InputError "shown: rule (got value)" if the file is damaged or ends early.
[[nodiscard]] PolygonSoup ReadAsciiStl(const std::string& shown, const std::string& bytes);
[[nodiscard]] PolygonSoup ReadBinaryStl(const std::string& shown, const std::string& bytes);

/// Whether `bytes` are a binary STL file: its length follows from its number of triangles. ASCII
/// files begin with "solid", but so do some binary ones.
[[nodiscard]] bool IsBinaryStl(const std::string& bytes);

/// How many triangles a binary STL file has by its header; 0 if it ends within that.
[[nodiscard]] std::uint32_t NumBinaryTriangles(const std::string& bytes);

}  // namespace railcast
