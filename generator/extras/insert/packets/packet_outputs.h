#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/extras/ros/recording/bag_recording.h"
#include "generator/extras/insert/inserted_frame.h"
#include "generator/extras/insert/recorded_firings.h"

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

/// MakeCopyOutput() of a bag.
[[nodiscard]] std::unique_ptr<InsertedOutput> MakeBagOutput(const BagSource& source,
                                                            const std::filesystem::path& folder);

/// @throws InputError if the bag's topic has neither packets nor clouds that MakeBagOutput() edits.
void CheckCanEdit(const BagSource& source);

/// The checksum of a UDP datagram after bytes of it have changed (RFC 1624): right if it was right
/// before, and 0, which stands for none, if it was 0.
/// @param place Of the first byte, counted from UDP's header.
[[nodiscard]] std::uint16_t ChangedChecksum(std::uint16_t checksum,
                                            std::size_t place,
                                            std::span<const char> before,
                                            std::span<const char> after);

/// Makes the output of a capture or a bag: in `folder`, a copy of it under its own name, in which
/// only the edited returns of packets, or the edited messages of the topic, differ. Beside a
/// capture stands what its sensor cannot be decoded without. The copy has the suffix
/// kUnfinishedSuffix until InsertedOutput::Finish().
///
/// Packets state ranges in whole units and intensities in bytes, and in dual modes the farther
/// return first: the frame is what they say when they are decoded again. A return that they cannot
/// state is an InputError.
/// @param source As OpenRecording() took it: RecordingInfo::source.
/// @returns Null if that is neither a capture nor a bag.
/// @throws InputError if it cannot be read, or the copy not be made.
[[nodiscard]] std::unique_ptr<InsertedOutput> MakeCopyOutput(const std::filesystem::path& source,
                                                             const std::filesystem::path& folder);

}  // namespace railcast
