#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "core/mesh/polygon_soup.h"

namespace railcast {

/// How a mesh file is to be understood. What is absent is taken from the file where its format
/// says it (glTF, FBX, DAE and 3DS); all others are taken to be in metres with z up.
struct MeshUnits {
  std::optional<double> unit_m;  ///< Metres per file unit.
  std::optional<bool> y_up;
};

/// Reads a mesh file: OBJ, PLY, STL or OFF, and if railcast was built with assimp also glTF, FBX,
/// DAE and 3DS. The content decides which it is; the extension counts only for OBJ files without
/// vertices.
/// @throws InputError with lines "file: rule" or "file: line N: rule (got value)", of OBJ and OFF
///   files one for each line with a fault (20 at most), if the file cannot be read, is damaged or
///   of no known format, has coordinates that are not finite or too far from its origin for the
///   precision of its format, or if no triangle remains.
///
///     ImportedMesh wagon = ReadMesh("wagon.obj", {.unit_m = 0.01, .y_up = true});
[[nodiscard]] ImportedMesh ReadMesh(const std::filesystem::path& file, const MeshUnits& units = {});

/// As ReadMesh(), for the bytes of a file without others beside it.
/// @param file Named in messages; its extension counts as above.
[[nodiscard]] ImportedMesh ParseMesh(std::string bytes,
                                     const std::filesystem::path& file,
                                     const MeshUnits& units = {});

}  // namespace railcast
