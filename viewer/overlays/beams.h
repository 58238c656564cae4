#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "railcast/io/recording.h"
#include "railcast/lidar.h"
#include "viewer/overlays/overlays.h"

namespace railcast {

/// Direction and time of each firing of a grid, including those without a return, at row * columns
/// + column.
struct Beams {
  std::uint32_t rows{};
  std::uint32_t columns{};
  /// Unit vectors in the sensor's axes at the firing; NaN where unknown.
  std::vector<Eigen::Vector3f> directions;
  std::vector<std::uint32_t> times_ns;  ///< Time since the stamp.
};

/// Takes the beams exactly from the scenario's pattern.
[[nodiscard]] Beams BeamsOf(const ScanPattern& pattern);

/// Estimates the directions from the frame's own points (MakeScanTable()) and takes its times.
/// Empty if its slots are not firings, or not a grid of at least 2 x 2 with points.
[[nodiscard]] std::optional<Beams> BeamsOf(const RecordedFrame& recorded);

/// Range at which the segments of empty beams begin, away from the sensor, where all of them meet.
inline constexpr double kEmptyBeamStart_m = 2.0;
/// Range at which they end if it is not known what the beam hit.
inline constexpr double kEmptyBeamStub_m = 12.0;

/// Opacity of beams that hit something, and of beams that hit nothing, of which there are many.
inline constexpr float kLostBeamOpacity = 0.2F;
inline constexpr float kOpenBeamOpacity = 0.012F;

/// Draws the fan of a frame's firings without a return: one segment along each, in the order of
/// their slots, in the colour of its outcome (viewer/color/palette.h), or of `kUnknownOutcomeRgb`
/// where the recording has no outcomes. A segment goes from 2 m to the true range of what was hit
/// and not detected; where that is not known, or nothing was hit, it goes to 12 m: long enough to
/// show the fan, short enough to leave the scene clear. For hits nearer than 2 m (on the ego
/// vehicle, or below the minimum range of the sensor) the segment begins at the sensor.
///
/// Segments are turned from the sensor's axes at the firing into those at the stamp (ScanMotion),
/// as the points are. The overlay is empty if the frame's slots are not firings; firings of unknown
/// direction are left out.
/// @pre `beams` has the frame's rows and columns.
[[nodiscard]] Overlay DrawEmptyBeams(const RecordedFrame& recorded, const Beams& beams);

}  // namespace railcast
