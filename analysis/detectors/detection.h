#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "analysis/detectors/box_overlap.h"
#include "analysis/detectors/gauge_ahead.h"

namespace railcast {

/// A box that a detector reports, where it was at the frame's stamp.
struct DetectedBox {
  OrientedBox box;
  std::uint32_t label{};   ///< That of most of its points; 0 without points or labels.
  std::string class_name;  ///< As the detector calls it; may be empty.
};

/// What a detector reports of one frame.
struct FrameDetections {
  std::vector<DetectedBox> boxes;
  double latency_s{};  ///< From the frame's stamp until it is known.
};

/// The box of a cluster of points, along the track. Every side is at least 0.1 m long: a scan line
/// has no height.
/// @pre `places` is not empty.
[[nodiscard]] OrientedBox BoxOfCluster(const OwnTrack& track,
                                       const std::vector<PlaceByTrack>& places);

/// The label that most of them have, the least of several; 0 if there is none.
[[nodiscard]] std::uint32_t MostFrequentLabel(const std::vector<std::uint32_t>& labels);

}  // namespace railcast
