#pragma once

#include <string>
#include <string_view>

#include "core/mesh/polygon_soup.h"

namespace railcast {

/// Reads the polygons of a PLY file held in `bytes`: ASCII or binary, in either byte order, with
/// coordinates of any type, and faces as `vertex_indices` or `vertex_index`. Lines of the header
/// `comment material NAME` name the materials that the property `material_index` of faces counts
/// from 0. All else is passed over.
///
/// It is railcast's own because OpenMesh reads double coordinates of binary files as 0.
/// @param shown Name of the file in error messages.
/// @param largest Largest coordinate that is allowed.
/// @throws InputError "shown: rule (got value)" if the file is damaged or ends early.
[[nodiscard]] PolygonSoup ReadPlyMesh(const std::string& shown,
                                      std::string_view bytes,
                                      double largest);

/// Reads a PLY file of scenarios/models as it is, about its own origin, by a shorter way: it is
/// binary, its vertices are floats in the order of the parts, and its faces are triangles of 16-bit
/// corners with a `material_index`.
[[nodiscard]] ImportedMesh ReadShippedPly(std::string_view bytes);

}  // namespace railcast
