#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "railcast/io/recording.h"

namespace railcast {

/// A new shape of a frame, and where its slots go.
struct NewSlots {
  std::uint32_t rows{};
  std::uint32_t columns{};
  std::uint32_t returns{};
  std::vector<std::uint32_t> of_slot;  ///< For each old slot its new one, or kNoSlot.

  [[nodiscard]] std::size_t num_cells() const { return std::size_t{rows} * columns; }
};

/// Gives a frame a grid of another shape. Slots that nothing goes to are empty; what became of
/// their firings (`outcome`) is then not known of the frame any more.
void MoveSlots(const NewSlots& to, RecordedFrame& recorded);

/// Returns for each slot the entry it was read from, or kNoSlot; empty if the frame has no entries.
[[nodiscard]] std::vector<std::uint32_t> EntriesOfSlots(const RecordedFrame& recorded);

}  // namespace railcast
