#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/mesh/assimp_reader.h"
#include "core/mesh/polygon_soup.h"

namespace railcast {

/// How a mesh file is to be understood. What is absent is taken from the file where its format
/// says it (glTF, FBX and DAE; the unit also by a comment at the head of OBJ and PLY); all others
/// are taken to be in metres with z up.
struct MeshUnits {
  std::optional<double> unit_m;  ///< Metres per file unit.
  std::optional<bool> y_up;
};

/// How many corners a face may have.
inline constexpr std::size_t kMostFaceCorners = 10'000;

/// Reads a mesh file, or one that railcast holds (ShippedFile()): OBJ, PLY, STL or OFF, and if
/// railcast was built with assimp also glTF, FBX, DAE and 3DS. The content decides which it is; the
/// extension counts only for OBJ files without vertices.
/// @throws InputError with lines "file: rule" or "file: line N: rule (got value)", of OBJ and OFF
///   files one for each line with a fault (20 at most), if the file cannot be read, is damaged or
///   of no known format, has coordinates that are not finite or too far from its origin for the
///   precision of its format, or if no triangle remains.
///
/// What it did not take as it stands (ImportedMesh::remarks) it also publishes.
///
///     ImportedMesh wagon = ReadMesh("wagon.obj", {.unit_m = 0.01, .y_up = true});
[[nodiscard]] ImportedMesh ReadMesh(const std::filesystem::path& file, const MeshUnits& units = {});

/// The other files that ReadMesh() reads with a mesh file, each once, in the order in which it
/// names them: the buffers of a glTF file and, where they are there, the material libraries (MTL)
/// of an OBJ file. All lie in its folder. No mesh is read with any other file.
/// @param bytes Of the mesh file.
/// @throws InputError "file: rule (got value)" if a buffer is not there, or not in the folder.
[[nodiscard]] std::vector<FileBeside> FilesBesideMesh(const std::string& bytes,
                                                      const std::filesystem::path& file);

/// As ReadMesh(), for the bytes of a file without others beside it.
/// @param file Named in messages; its extension counts as above.
[[nodiscard]] ImportedMesh ParseMesh(std::string bytes,
                                     const std::filesystem::path& file,
                                     const MeshUnits& units = {});

}  // namespace railcast
