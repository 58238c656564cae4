#pragma once

#include <map>
#include <string>
#include <vector>

namespace railcast {

/// The names in the `mtllib` lines of an OBJ file, in their order. A line may name several files,
/// or one with blanks in its name: it gives the whole rest of the line and, if there are several,
/// each word of it.
[[nodiscard]] std::vector<std::string> MaterialLibrariesOf(const std::string& obj);

/// Reads from a Wavefront MTL file the luminance of each material's diffuse colour (`Kd`), if it
/// has one and no picture (`map_Kd`) changes it, and adds it to `luminances`. A material that
/// another file has described already keeps that.
///
/// The format's description calls Kd a reflectivity, so it is taken to be linear.
/// @param shown Name of the file in error messages.
/// @throws InputError "shown: line N: rule (got value)" for each Kd line with a fault.
void ReadMtl(const std::string& shown,
             const std::string& bytes,
             std::map<std::string, double>& luminances);

}  // namespace railcast
