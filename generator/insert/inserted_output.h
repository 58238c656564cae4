#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "generator/insert/inserted_frame.h"
#include "generator/insert/recorded_firings.h"

namespace railcast {

/// Writes a recording with what was inserted, frame by frame, in the recording's own format: all
/// that was not changed byte for byte as it was.
class InsertedOutput {
 public:
  virtual ~InsertedOutput() = default;

  /// Takes the recording's frames in their order, from the first on that is wanted, without gaps.
  /// @return For each point of the frame's cloud, in its order, the slot; nothing of packets.
  /// @throws InputError if what was inserted cannot be stated in the format.
  virtual std::optional<std::vector<std::uint32_t>> Write(const RecordedFirings& firings,
                                                          const InsertedFrame& inserted) = 0;
  /// Writes what follows the last frame.
  virtual void Finish() = 0;
};

}  // namespace railcast
