#pragma once

#include "analysis/fit/truth_trials.h"

namespace railcast {

/// The trials of a labelled cloud without truth: of its flat pieces
/// (analysis/stats/plane_patches.h) whose points have one label, `surface`; 0, the label of
/// nothing, makes none.
///
/// What is expected of a point is its piece's plane. That was fitted to these very points, by three
/// numbers: residuals are larger by sqrt(n / (n - 3)), so that their mean square is the noise's.
/// Roughness counts as noise. What is lost nobody knows.
/// @param facts Without `scan` neighbours are those in space.
void ForEachLabelTrial(const RecordedFrame& recorded,
                       const SensorFacts& facts,
                       const TrialTaker& take);

}  // namespace railcast
