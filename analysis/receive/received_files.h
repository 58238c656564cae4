#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>

#include "railcast/io/stream.h"

namespace railcast {

/// Records a stream: frames/000000.pcd, ... in the order of arrival with every field that was sent,
/// and frames.csv with one line per file: file, run, frame, stamp_ns, the pose at the stamp (x y z
/// in m, qx qy qz qw), points, lost_points and, where points are in the sensor's axes, the time
/// from the stamp to the last firing and the pose at that.
class ReceivedFiles {
 public:
  /// @throws InputError if the directory cannot be made or already holds a recording.
  explicit ReceivedFiles(const std::filesystem::path& directory);

  /// @throws InputError if the file cannot be written.
  void Write(const ReceivedFrame& frame);

 private:
  std::filesystem::path directory_;
  std::ofstream lines_;
  std::uint32_t num_files_{};
};

}  // namespace railcast
