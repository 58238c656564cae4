#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "analysis/report/report.h"
#include "analysis/stats/class_balance.h"
#include "analysis/stats/coverage.h"
#include "analysis/stats/density.h"
#include "analysis/stats/difficulty.h"
#include "analysis/stats/dropout.h"
#include "analysis/stats/gauge_points.h"
#include "analysis/stats/holes.h"
#include "analysis/stats/intensity.h"
#include "analysis/stats/noise.h"
#include "analysis/stats/object_points.h"
#include "analysis/stats/temporal_noise.h"
#include "analysis/stats/velocity.h"
#include "core/io/recording/scan_table.h"
#include "railcast/io/recording.h"

namespace railcast {

/// All results of `railcast-analyze stats` for a recording. Its size does not depend on the
/// recording's length.
struct Statistics {
  Dropout dropout;
  Holes holes;
  Density density;
  Noise noise;
  TemporalNoise temporal_noise;
  Intensity intensity;
  Coverage coverage;
  ClassBalance classes;
  ObjectPoints objects;
  Difficulty difficulty;
  GaugePoints gauge;  ///< Empty without a track.
  Velocity velocity;

  /// Adds everything except temporal noise, which needs two frames, and points in the gauge, which
  /// need a track.
  /// @param scan Of the frame; null if it is not a grid.
  void Add(const RecordedFrame& recorded, const ScanTable* scan);
  void Add(const Statistics& other);
  /// Drops what is counted by ring: rings of different sensors have nothing in common but their
  /// numbers.
  void ForgetRings();
};

/// Called after each pair of frames, on one thread at a time.
using StatisticsProgress = std::function<void(std::size_t num_frames)>;

/// Reads a recording to its end. Frames are processed in parallel and summed in their order, so
/// that the figures do not depend on the number of threads.
/// @param track Of the vehicle, in the world of the recording's poses; null = not known.
/// @throws InputError as the recording does, and if a frame has no pose although there is a track.
[[nodiscard]] Statistics MeasureStatistics(Recording& recording,
                                           const StatisticsProgress& on_progress,
                                           const FrameTrack* track = nullptr);

/// @param sources The recordings measured, one or more, all with the same labels and materials.
/// @param command Command line, for a reader to repeat.
[[nodiscard]] Report MakeStatisticsReport(const Statistics& statistics,
                                          const std::vector<RecordingInfo>& sources,
                                          const std::string& command);

/// Makes a sheet of pictures of recordings: a row for each sensor, by its name, and for each
/// camera, of frames spread evenly over all its recordings. Defined in sheet.cpp.
/// @throws InputError if a recording cannot be read.
[[nodiscard]] Picture MakeSheet(const std::vector<std::filesystem::path>& recordings);

}  // namespace railcast
