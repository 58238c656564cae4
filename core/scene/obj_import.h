#pragma once

#include <filesystem>
#include <iosfwd>
#include <string>

#include "railcast/scene.h"

namespace railcast {

/// Reads a Wavefront OBJ file as a triangle soup. Meshes need not be manifold or closed; faces may
/// have any number of corners, planar or not, convex or not. Negative indices and groups are
/// understood. Normals, texture coordinates, materials, lines and points are ignored.
///
/// Lengths are converted to metres (`unit_m` metres per file unit). If `y_up`, the mesh is rotated
/// by 90 degrees about x: its y becomes z and its z becomes -y. Otherwise the file's axes and
/// origin are kept. Triangles without area (in float32), faces with only one or two corners (which
/// occur in well-known files) and unused vertices are dropped.
///
/// OpenMesh parses the files, but it drops what it cannot read, which shifts all later indices.
/// Therefore every line is checked before, and the number of elements read is checked after
/// parsing.
///
/// @throws InputError with one line, "file: rule" or "file: line N: rule (got value)", if the file
///   cannot be read, a coordinate is not a finite number, an index refers to no vertex, or no
///   triangle remains.
[[nodiscard]] Mesh ReadObj(const std::filesystem::path& file, double unit_m, bool y_up);

/// As ReadObj(), for a stream that error messages call `shown`.
[[nodiscard]] Mesh ParseObj(std::istream& in, const std::string& shown, double unit_m, bool y_up);

}  // namespace railcast
