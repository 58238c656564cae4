#pragma once

#include <filesystem>
#include <string_view>

namespace railcast {

/// Whether a file begins as OpenStreetMap's PBF does.
[[nodiscard]] bool IsPbf(std::string_view begin);

/// Checks how the blobs of an OpenStreetMap PBF file are compressed. GDAL, which reads it, passes
/// over what is compressed in another way than with zlib, so that a map would seem empty.
///
/// The format is that of https://wiki.openstreetmap.org/wiki/PBF_Format. Files that end too early
/// are left to GDAL, which refuses them.
/// @throws InputError for the first blob that GDAL would pass over.
void CheckPbfBlobs(const std::filesystem::path& file);

}  // namespace railcast
