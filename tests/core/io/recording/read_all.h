#pragma once

#include <filesystem>
#include <vector>

#include "railcast/io/recording.h"

namespace railcast {

/// Returns every frame of a recording.
inline std::vector<RecordedFrame> ReadAll(Recording& recording) {
  std::vector<RecordedFrame> frames;
  while (const auto read = recording.Next()) frames.push_back((*read)());
  return frames;
}

inline std::vector<RecordedFrame> ReadAll(const std::filesystem::path& source) {
  return ReadAll(*OpenRecording(source));
}

}  // namespace railcast
