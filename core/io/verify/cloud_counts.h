#pragma once

#include <filesystem>
#include <string>

#include "core/base/error.h"
#include "core/io/cloud/point_table.h"
#include "core/io/strict_json.h"
#include "railcast/io/cloud_files.h"

namespace railcast {

/// A frame's cloud and what its numbers mean.
struct CountedCloud {
  const PointTable& cloud;
  const FrameFormat& format;
  const LabelTable& labels;
  std::filesystem::path file;  ///< Its name.
};

/// Counts a cloud's points, by label and by outcome where it has these fields, and adds a fault for
/// each count of the frame's line that differs: "frames.jsonl:3: /points: must be 7, as counted in
/// frames/000012.pcd (got 8)".
/// @param line Of frames.jsonl.
/// @param place Names the line.
/// @throws StrictJson::exception if the line has no counts.
void CompareWithCloud(const CountedCloud& counted,
                      const StrictJson& line,
                      const std::string& place,
                      ErrorList& faults);

}  // namespace railcast
