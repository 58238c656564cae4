#pragma once

#include <filesystem>
#include <string>

#include "generator/insert/plan/pose_file.h"

namespace railcast {

/// Reads the poses of a sensor from a file of OpenLABEL 1.0 (ASAM, 2021): from its coordinate
/// system through those above it, by the `transforms` of a frame where there are any, else by their
/// `pose_wrt_parent`, up to one that has none.
/// @param sensor The name of its coordinate system.
/// @throws InputError "FILE: /openlabel/...: rule" if the file is none, or if no transform of a
///   frame is on the way, so that the poses are not known.
[[nodiscard]] PoseFile ReadOpenLabelPoses(const std::filesystem::path& file,
                                          const std::string& sensor);

}  // namespace railcast
