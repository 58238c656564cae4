#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "railcast/io/recording.h"

namespace railcast {

/// A frame and its points as they are shown.
struct ShownFrame {
  std::shared_ptr<const RecordedFrame> recorded;
  /// x, y, z of each point in turn, in the sensor's axes at the stamp: the motion of the sensor and
  /// of objects within the scan is undone where pose and times are known.
  std::vector<float> positions_m;
  std::vector<std::uint32_t> slots;  ///< Slot of each point in `recorded`.

  [[nodiscard]] std::size_t num_points() const { return slots.size(); }
  [[nodiscard]] const Frame& frame() const { return recorded->frame; }
};

[[nodiscard]] ShownFrame MakeShownFrame(RecordedFrame recorded);

}  // namespace railcast
