#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "core/io/recording/recording.h"

namespace railcast {

/// Whether a file's name says that it holds a cloud: .pcd, .ply or .bin (KITTI's).
[[nodiscard]] bool IsCloudFile(const std::filesystem::path& file);

/// The cloud files in a directory in natural order of their names: 9.pcd comes before 10.pcd.
[[nodiscard]] std::vector<std::filesystem::path> CloudFilesIn(
    const std::filesystem::path& directory);

/// Clouds without poses, in this order. @param kind What people call it.
[[nodiscard]] std::unique_ptr<Recording> OpenClouds(const std::filesystem::path& source,
                                                    const std::string& kind,
                                                    std::vector<std::filesystem::path> files);

/// What `railcast-analyze receive --out` keeps: clouds with the poses of frames.csv. Their points
/// are taken for the sensor's axes, the stream's default.
/// @throws InputError if frames.csv cannot be read.
[[nodiscard]] std::unique_ptr<Recording> OpenReceived(const std::filesystem::path& directory);

}  // namespace railcast
