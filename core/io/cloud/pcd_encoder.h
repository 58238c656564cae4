#pragma once

#include <string>
#include <string_view>

#include "core/io/cloud/cloud.h"

namespace railcast {

/// What a PCD file calls a type of numbers: I, U or F.
[[nodiscard]] char PcdLetter(NumberType type);

/// The header of a PCD v0.7 file up to its DATA line, "DATA binary" for the data "binary", byte for
/// byte as PCL's PCDWriter writes it. VIEWPOINT is the identity.
/// @pre The points are packed: each field follows the one before it.
[[nodiscard]] std::string PcdHeaderOf(const Cloud& cloud, std::string_view data);

/// Encodes a cloud as a PCD v0.7 file.
/// @param is_compressed Encoding binary_compressed; a cloud without points is binary, since PCL
///   reads no compressed one.
/// @pre As of PcdHeaderOf().
[[nodiscard]] std::string EncodePcd(const Cloud& cloud, bool is_compressed);

/// Appends the data of a PCD file of encoding binary_compressed: both sizes and the LZF of `plain`.
/// @param plain Each field for all points, one field after another.
void AppendCompressed(const std::string& plain, std::string& bytes);

}  // namespace railcast
