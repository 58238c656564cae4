#pragma once

#include <pcl/PCLPointCloud2.h>

#include <filesystem>

namespace railcast {

/// Every field of every point of a .pcd or .ply file.
/// @throws InputError with one line if it cannot be read.
[[nodiscard]] pcl::PCLPointCloud2 ReadPointFile(const std::filesystem::path& file);

}  // namespace railcast
