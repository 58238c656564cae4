#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "generator/extras/insert/plan/recorded_way.h"
#include "railcast/alignment.h"

namespace railcast {

/// The line on which a plan measures chainages, and where the vehicle is on it.
struct RecordedLine {
  AlignmentSpec alignment;
  /// Chainage of the alignment where the plan's chainage is 0: the alignment of a driven path
  /// begins kBeyondPath_m before the first frame.
  double zero_s_m{};
  std::vector<double> at_frames_m{};  ///< Chainage of the alignment at which each frame begins.
  /// For each frame, whether the vehicle faces rising chainage.
  std::vector<bool> faces_up{};

  /// How far a driven path goes on straight ahead and behind, at the gradients of its ends.
  static constexpr double kBeyondPath_m = 1000.0;
};

/// Makes a line of the vehicle's own way: a spline through its places 10 m apart. Chainage rises
/// the way the vehicle faces, and is 0 where it is in the first frame.
/// @param source Names the recording in messages.
/// @throws InputError if the vehicle turns back on its way.
[[nodiscard]] RecordedLine LineOfWay(const RecordedWay& way, const std::string& source);

/// Finds the vehicle on a line that is given.
/// @throws InputError if the way does not keep to the line: "recording: frame 3: rule (got
///   value)".
[[nodiscard]] RecordedLine GivenLine(const AlignmentSpec& alignment,
                                     const RecordedWay& way,
                                     const std::string& source);

}  // namespace railcast
