#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "railcast/io/recording.h"
#include "railcast/lidar.h"

namespace railcast {

/// Entry of a slot that was read from no point of the recording.
inline constexpr std::uint32_t kNoEntry = std::numeric_limits<std::uint32_t>::max();
/// Cell of a grid in which the sensor does not fire.
inline constexpr std::uint32_t kNoFiring = std::numeric_limits<std::uint32_t>::max();

/// A recorded frame as the firings that it came from, those without a return included.
struct RecordedFirings {
  /// The frame with a slot for every return of every firing. It may have more columns than the
  /// frame as read: firings that returned nothing to any channel are not in clouds.
  RecordedFrame recorded;
  /// For each slot, the index of what it was read from: the point of a file or a message, in its
  /// order, or kNoEntry. Slots without a point have one where the cloud is organised. Empty for
  /// recordings whose slots say by themselves where their bytes are (captures).
  std::vector<std::uint32_t> entry_of_slot;
  /// The firings, in the axes of the points (`recorded.axes`): the sensor's at the time of each, or
  /// where its motion is undone at the stamp, where beams leave along the way. rows and columns are
  /// those of `recorded.frame`; not every cell need have a firing.
  ScanPattern pattern;
  /// For each cell (row * columns + column) the index of its firing in `pattern`, or kNoFiring.
  std::vector<std::uint32_t> firing_of_cell;
  /// Whether no firings were found, so that each recorded point counts as a firing of its own and
  /// nothing is known of the others.
  bool are_points_alone = false;

  /// The first slot of a cell; its returns follow each other.
  [[nodiscard]] std::size_t SlotOfCell(std::size_t cell) const {
    return cell * recorded.frame.returns;
  }
};

}  // namespace railcast
