#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "viewer/composition/compose.h"
#include "viewer/composition/composition.h"
#include "viewer/frames/shown_frame.h"

namespace railcast {

/// What became of a point from one recording of a frame to another recording of it.
enum class Change : std::uint8_t {
  kSame,      ///< In both with the same intensity, or where one of them has no intensities.
  kWeaker,    ///< In both, with a lower intensity in the second.
  kStronger,  ///< In both, with a higher intensity in the second.
  kAdded,     ///< In the second only.
  kRemoved    ///< In the first only.
};

/// The points of two frames, compared.
struct ChangedPoints {
  std::vector<Change> of_second;       ///< One per point of the second; never kRemoved.
  std::vector<std::uint32_t> removed;  ///< The other points of the first, by rising number.
};

/// Compares the points of two recordings of one frame. Points are the same if their recorded
/// positions are equal to the last bit, whichever order and slots they have; of several at one
/// place, each has at most one counterpart.
[[nodiscard]] ChangedPoints CompareFrames(const ShownFrame& first, const ShownFrame& second);

/// Shows the second frame, coloured by what changed since the first, and with it the points that
/// only the first has. The first cloud of the composition is the second frame. Frames with poses
/// are registered in world coordinates.
[[nodiscard]] Composition ComposeChanges(const std::shared_ptr<const ShownFrame>& first,
                                         const std::shared_ptr<const ShownFrame>& second,
                                         const Choices& choices);

}  // namespace railcast
