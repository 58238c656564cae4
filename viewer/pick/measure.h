#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>

#include "core/base/transform.h"
#include "core/io/recording/recording.h"
#include "viewer/frames/shown_frame.h"

namespace railcast {

/// A point that was picked. It stays what it is when other frames are shown.
struct Pick {
  std::shared_ptr<const RecordedFrame> recorded;
  Vector3 at_stamp_m;  ///< In the sensor's axes at the frame's stamp.
};

/// @pre point < shown.num_points()
[[nodiscard]] Pick PickOf(const ShownFrame& shown, std::size_t point);

/// Whether they are the same frame of the same recording, perhaps read twice.
[[nodiscard]] bool AreOfOneFrame(const RecordedFrame& a, const RecordedFrame& b);

/// The way from one pick to another.
///
/// In one frame along the sensor's axes at its stamp: "12.345 m (dx 12.000, dy 2.900, dz 0.012;
/// level 12.345 m)". In two frames, of one recording or of two, along those of the world: "12.345 m
/// (east 12.000, north 2.900, up 0.012; level 12.345 m)"; nothing unless both have poses. Level is
/// the distance without dz or up.
[[nodiscard]] std::optional<std::string> DistanceText(const Pick& from, const Pick& to);

}  // namespace railcast
