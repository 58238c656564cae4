#pragma once

#include <optional>
#include <string>
#include <vector>

#include "railcast/io/recording.h"

namespace railcast {

/// The rung that made the frames of one or several runs of a scenario.
struct RungUsed {
  std::string name;  ///< As the scenario names it.
  /// Whether every run has beams with a width (effect `footprint`). Absent: fidelity `auto` chose,
  /// and a run that has not finished, or clouds that are merged, do not record what.
  std::optional<bool> has_wide_beams;

  /// "surface: one ray per beam".
  [[nodiscard]] std::string InWords() const;
  /// What single rays do to objects far off; empty if the beams have a width.
  [[nodiscard]] std::string Warning() const;
};

/// @pre There is at least one run, and all are sequences of the same scenario.
[[nodiscard]] RungUsed RungOf(const std::vector<RecordingInfo>& runs);

}  // namespace railcast
