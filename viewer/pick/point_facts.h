#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/io/recording/recording.h"
#include "viewer/frames/shown_frame.h"

namespace railcast {

/// All that is known of one point, line by line: names and values in two columns, 60 ASCII
/// characters at most unless the recording's own names want more. First what was measured, then
/// what else a foreign cloud has, then, after a line "truth", what was true. A field that the
/// recording lacks has no line; a value that is absent is "-".
///
///     file             frame_000003.pcd
///     position               12.345      -2.900       0.012 m
///     label            wagon (12)
///     noise            +1.6 mm
///
/// `position` is in the sensor's axes at the firing; `at the stamp` follows where motion within the
/// scan makes it another, `in the world` where the pose is known.
/// @param info Of the recording that the frame is from: names of labels and materials.
/// @pre point < shown.num_points()
[[nodiscard]] std::vector<std::string> PointFacts(const ShownFrame& shown,
                                                  const RecordingInfo& info,
                                                  std::size_t point);

}  // namespace railcast
