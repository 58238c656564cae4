#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "generator/record/frame_record.h"
#include "generator/run/run_identity.h"

namespace railcast {

/// A file of a sequence directory that gets one line per frame.
struct LineFileName {
  std::string name;
  std::string_view header;
};

/// Returns the line files of a format in the order in which they are written; frames.jsonl is the
/// last.
[[nodiscard]] std::vector<LineFileName> LineFileNames(const FrameFormat& format);

/// How far an interrupted run got.
struct SequenceProgress {
  std::uint32_t num_done{};
  FrameCounts counts;
  std::string first_pose_line;  ///< Line of poses.csv, if num_done > 0.
  /// For each line file, the size of the header and the lines of done frames.
  std::vector<std::uint64_t> keep_bytes;
};

/// Reads a directory's line files and frames, and counts the leading frames that are complete:
/// whose files and lines have the hashes that their line of frames.jsonl states.
/// @throws InputError if a file exists but cannot be read.
[[nodiscard]] SequenceProgress FindProgress(const SequenceSpec& spec);

}  // namespace railcast
