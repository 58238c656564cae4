#pragma once

#include <string>
#include <string_view>

#include "core/mesh/polygon_soup.h"

namespace railcast {

/// Whether a file begins like an OFF file: with OFF, or with letters for what its vertices have
/// besides (as in COFF), after comments.
[[nodiscard]] bool IsOff(std::string_view bytes);

/// Reads an ASCII OFF file held in `bytes`: a line for each vertex, of which the first three
/// numbers count, and a line for each face, which may go on with its colour.
///
/// It is railcast's own because OpenMesh takes a face's colour for the next face.
/// @param shown Name of the file in error messages.
/// @param largest Largest coordinate that is allowed.
/// @throws InputError "shown: line N: rule (got value)" for each line with a fault, and if the file
///   ends early.
[[nodiscard]] PolygonSoup ReadOff(const std::string& shown, std::string_view bytes, double largest);

}  // namespace railcast
