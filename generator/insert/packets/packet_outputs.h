#pragma once

#include <filesystem>
#include <memory>

#include "generator/insert/inserted_output.h"

namespace railcast {

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
