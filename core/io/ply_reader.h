#pragma once

#include <pcl/PCLPointCloud2.h>

#include <filesystem>
#include <string>

namespace railcast {

/// The points of a PLY file, ASCII or binary little-endian, with every scalar property under its
/// own name and type. Faces and other elements are left out; a cloud without a point is none of
/// PCL's concern and allowed.
///
/// Read here and not by PCL's PLYReader: that one takes a cloud's shape from comments and camera
/// elements, turns colours and intensities into other types, and crashes where they contradict the
/// number of points.
/// @throws InputError with one line if the file cannot be read or is damaged.
[[nodiscard]] pcl::PCLPointCloud2 ReadPly(const std::filesystem::path& file);

/// The same of a file held in `bytes`. @param file Named in errors.
[[nodiscard]] pcl::PCLPointCloud2 ParsePly(const std::string& file, const std::string& bytes);

}  // namespace railcast
