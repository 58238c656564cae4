#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "generator/frame_record.h"
#include "generator/sequence_spec.h"

namespace railcast {

/// A file of a sequence directory that gets one line a frame.
struct LineFileName {
  std::string name;
  std::string_view header;
};

/// The line files of a format, in the order they are written; frames.jsonl is the last.
[[nodiscard]] std::vector<LineFileName> LineFileNames(FrameFormat format);

/// How far an interrupted run came.
struct SequenceProgress {
  std::uint32_t num_done{};
  FrameCounts counts;
  std::string first_pose_line;            ///< Of poses.csv, if num_done > 0.
  std::vector<std::uint64_t> keep_bytes;  ///< Of each line file: header and lines of done frames.
};

/// Reads a directory's line files and frames and counts the frames, from the first, that are whole:
/// whose files and lines have the hashes that their line of frames.jsonl names.
/// @throws InputError if a file is there but cannot be read.
[[nodiscard]] SequenceProgress FindProgress(const SequenceSpec& spec);

}  // namespace railcast
