#pragma once

#include <cstdint>
#include <functional>
#include <limits>

#include "analysis/fit/trial.h"
#include "core/detect/detect_spec.h"
#include "core/io/recording/recording.h"
#include "core/io/recording/scan_table.h"

namespace railcast {

/// What is known of a sensor beforehand.
struct SensorFacts {
  double range_min_m = 0.5;
  double range_max_m = std::numeric_limits<double>::infinity();
  BeamSpec beam;                    ///< Width and pulse, for pulse stretch.
  const ScanTable* scan = nullptr;  ///< Where the firings of a grid look; null = not known.
};

/// Takes a trial and its slot.
using TrialTaker = std::function<void(const Trial&, std::size_t slot)>;

/// Whether truth fields say what each firing of the frame should have met: true_range_m,
/// incidence_rad, and material or label.
[[nodiscard]] bool HasTruth(const RecordedFrame& frame);

/// The trials of a frame that has truth, `surface` being its material, or its label where it has no
/// materials; 0, the surface of nothing, makes none. Of `outcome` only is used whether there is a
/// point, and that a firing was blocked by the own vehicle: so much a recording shows.
///
/// Left out: what is expected within 1 m of the range gate's ends, firings whose point is clutter
/// (it hides what they should have met), and surfaces that share a beam with others.
/// @pre HasTruth(frame)
void ForEachTruthTrial(const RecordedFrame& recorded,
                       const SensorFacts& facts,
                       const TrialTaker& take);

}  // namespace railcast
