#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <string>
#include <vector>

#include "railcast/io/recording.h"
#include "viewer/frames/shown_frame.h"

namespace railcast {

/// Returns a number with `num_decimals` decimals, "-2.900", or "-" for NaN. A value that rounds to
/// zero has no sign.
[[nodiscard]] inline std::string FixedText(double value, int num_decimals) {
  if (std::isnan(value)) return "-";
  std::array<char, 352> text{};  // The largest double has 309 digits.
  std::snprintf(text.data(), text.size(), "%.*f", num_decimals, value);
  std::string fixed = text.data();
  const bool is_zero = fixed.find_first_not_of("-0.") == std::string::npos;
  return is_zero && fixed.front() == '-' ? fixed.substr(1) : fixed;
}

/// Lists all that is known of one point, line by line: names and values in two columns, at most 60
/// ASCII characters wide unless the recording's own names are longer. Measurements come first, then
/// the other fields of a foreign cloud, then, after a line "truth", the ground truth. A field that
/// the recording lacks has no line; an absent value is "-".
///
///     file             frame_000003.pcd
///     position               12.345      -2.900       0.012 m
///     label            wagon (12)
///     noise            +1.6 mm
///
/// `position` is in the sensor's axes at the firing. `at the stamp` follows where motion within the
/// scan makes it differ, `in the world` where the pose is known.
/// @param info The recording that the frame is from, with the names of labels and materials.
/// @pre point < shown.num_points()
[[nodiscard]] std::vector<std::string> PointFacts(const ShownFrame& shown,
                                                  const RecordingInfo& info,
                                                  std::size_t point);

}  // namespace railcast
