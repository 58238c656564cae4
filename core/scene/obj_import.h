#pragma once

#include <filesystem>
#include <iosfwd>
#include <string>

#include "core/scene/mesh.h"

namespace railcast {

/// Reads a Wavefront OBJ file as a triangle soup: nothing need be manifold or closed, faces may
/// have any number of corners (plane or bent, convex or not), negative indices and groups are
/// understood; normals, texture coordinates, materials, lines and points are passed over.
///
/// Lengths become metres (`unit_m` metres per file unit). A file that is `y_up` is turned a quarter
/// about x: its y becomes z and its z becomes -y. Otherwise the file's axes and origin are kept.
/// Triangles without an area (in float32) and vertices that no triangle uses are left out, and so
/// are faces of one or two corners, which well-known files hold: they have no area either.
///
/// Files are parsed by OpenMesh, which drops what it cannot read and so shifts all later indices;
/// therefore every line is checked first, and afterwards that it read as many as there were.
///
/// @throws InputError, one line "file: rule" or "file: line N: rule (got value)" per file, if it
///   cannot be read, a coordinate is no finite number, an index points at no vertex, or no triangle
///   is left.
[[nodiscard]] Mesh ReadObj(const std::filesystem::path& file, double unit_m, bool y_up);

/// The same of what a file holds, which messages call `shown`.
[[nodiscard]] Mesh ParseObj(std::istream& in, const std::string& shown, double unit_m, bool y_up);

}  // namespace railcast
