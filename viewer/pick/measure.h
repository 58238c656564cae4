#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>

#include "railcast/io/recording.h"
#include "railcast/transform.h"
#include "viewer/frames/shown_frame.h"

namespace railcast {

/// A picked point. It does not change when other frames are shown.
struct Pick {
  std::shared_ptr<const RecordedFrame> recorded;
  Vector3 at_stamp_m;  ///< In the sensor's axes at the frame's stamp.
};

/// @pre point < shown.num_points()
[[nodiscard]] Pick PickOf(const ShownFrame& shown, std::size_t point);

/// Returns whether both are the same frame of the same recording, which may have been read twice.
[[nodiscard]] bool AreOfOneFrame(const RecordedFrame& a, const RecordedFrame& b);

/// Returns the distance from one pick to another.
///
/// Within one frame it is given along the sensor's axes at the stamp: "12.345 m (dx 12.000, dy
/// 2.900, dz 0.012; level 12.345 m)". Between two frames, of one recording or of two, it is given
/// along the axes of the world: "12.345 m (east 12.000, north 2.900, up 0.012; level 12.345 m)";
/// empty unless both have poses. Level is the distance without dz or up.
[[nodiscard]] std::optional<std::string> DistanceText(const Pick& from, const Pick& to);

}  // namespace railcast
