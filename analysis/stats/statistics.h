#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "analysis/report/report.h"
#include "analysis/stats/coverage.h"
#include "analysis/stats/density.h"
#include "analysis/stats/dropout.h"
#include "analysis/stats/holes.h"
#include "analysis/stats/intensity.h"
#include "analysis/stats/noise.h"
#include "analysis/stats/object_points.h"
#include "analysis/stats/temporal_noise.h"
#include "core/io/recording/recording.h"
#include "core/io/recording/scan_table.h"

namespace railcast {

/// All that `railcast-analyze stats` finds out of a recording. Its size does not depend on the
/// recording's length.
struct Statistics {
  Dropout dropout;
  Holes holes;
  Density density;
  Noise noise;
  TemporalNoise temporal_noise;
  Intensity intensity;
  Coverage coverage;
  ObjectPoints objects;

  /// All but the temporal noise, which takes two frames.
  /// @param scan Of the frame; null if it is no grid.
  void Add(const RecordedFrame& recorded, const ScanTable* scan);
  void Add(const Statistics& other);
};

/// Called after each pair of frames, on one thread at a time.
using StatisticsProgress = std::function<void(std::size_t num_frames)>;

/// Reads a recording to its end. Frames are worked on in parallel and summed up in their order: the
/// same figures at any number of threads.
/// @throws InputError as the recording does.
[[nodiscard]] Statistics MeasureStatistics(Recording& recording,
                                           const StatisticsProgress& on_progress);

}  // namespace railcast
