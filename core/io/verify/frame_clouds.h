#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/io/cloud/cloud.h"
#include "core/io/run/frame_record.h"
#include "railcast/io/cloud_files.h"

namespace railcast {

/// Where counts are, and what they are compared with, in messages.
struct CountsPlace {
  std::string place;      ///< "manifest.json".
  std::string compared;   ///< "the sum over frames.jsonl".
  std::string is_absent;  ///< "is in no frame".
};

/// Adds a fault for each count that differs from what was counted: "place: /points: must be 7, the
/// sum over frames.jsonl (got 8)".
void CompareCounts(const FrameCounts& counted,
                   const FrameCounts& got,
                   const CountsPlace& place,
                   ErrorList& faults);

/// A frame's cloud and what its numbers mean.
struct CountedCloud {
  const Cloud& cloud;
  const FrameFormat& format;
  const LabelTable& labels;
  std::filesystem::path file;  ///< Its name.
};

/// Counts a cloud's points, by label and by outcome where it has these fields, and adds a fault for
/// each count of the frame's line that differs: "frames.jsonl:3: /points: must be 7, as counted in
/// frames/000012.pcd (got 8)".
/// @param place Names the line of frames.jsonl.
void CompareWithCloud(const CountedCloud& counted,
                      const FrameCounts& line,
                      const std::string& place,
                      ErrorList& faults);

/// What a line of frames.jsonl says of the clouds or the message that a bag or a trace holds of the
/// frame.
struct CloudsOfFrame {
  std::int64_t stamp_ns{};
  std::string hash;   ///< ContentHash() of its messages, one after another.
  std::string place;  ///< Of the line: "out/frames.jsonl:3".
};

}  // namespace railcast
