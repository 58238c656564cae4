#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>

#include "core/io/stream/received_frame.h"

namespace railcast {

/// Keeps a stream: frames/000000.pcd, ... in the order of arrival, every field that was sent; and
/// frames.csv, a line for each file: file, run, frame, stamp_ns, the pose at the stamp (x y z in m,
/// qx qy qz qw), points, lost_points.
class ReceivedFiles {
 public:
  /// @throws InputError if the directory cannot be made or holds a recording already.
  explicit ReceivedFiles(const std::filesystem::path& directory);

  /// @throws InputError if the system refuses.
  void Write(const ReceivedFrame& frame);

 private:
  std::filesystem::path directory_;
  std::ofstream lines_;
  std::uint32_t num_files_{};
};

}  // namespace railcast
