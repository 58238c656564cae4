#pragma once

#include <pcl/PCLPointCloud2.h>

#include <filesystem>

namespace railcast {

/// A PCD file of any encoding and with any fields, ours or another's.
///
/// PCL reads it after CheckPcd (pcd_header.h) has found the file sound. Compressed and ASCII files
/// give the same cloud as binary ones.
/// @throws InputError with one line if the file cannot be read or is damaged.
[[nodiscard]] pcl::PCLPointCloud2 ReadPcd(const std::filesystem::path& file);

}  // namespace railcast
