#pragma once

#include <filesystem>
#include <string>

#include "core/base/error.h"
#include "core/io/cloud/point_table.h"
#include "core/io/strict_json.h"
#include "railcast/io/cloud_files.h"

namespace railcast {

/// Where counts are, and what they are compared with, in messages.
struct CountsPlace {
  std::string place;      ///< "manifest.json".
  std::string compared;   ///< "the sum over frames.jsonl".
  std::string is_absent;  ///< "is in no frame".
};

/// Adds a fault for each count of a member of `object` that differs from what was counted: "place:
/// /points: must be 7, the sum over frames.jsonl (got 8)".
/// @param counted A number, or an object of numbers.
void CompareCounts(const StrictJson& counted,
                   const StrictJson& object,
                   const std::string& key,
                   const CountsPlace& place,
                   ErrorList& faults);

/// Sums the counts of each frame in frames.jsonl, for comparison with the manifest's totals.
class CountTotals {
 public:
  /// @param line A line of frames.jsonl.
  /// @throws StrictJson::exception if it has no counts.
  void Add(const StrictJson& line);

  /// Adds a fault for every total that differs: "place: points: must be 7, ... (got 8)".
  void Compare(const StrictJson& manifest, const std::string& place, ErrorList& faults) const;

 private:
  StrictJson sums_ = {{"points", 0U},
                      {"outcomes", StrictJson::object()},
                      {"points_per_label", StrictJson::object()}};
};

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
