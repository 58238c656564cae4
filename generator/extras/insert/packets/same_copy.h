#pragma once

#include <filesystem>
#include <memory>

#include "generator/extras/insert/clouds/recording_output.h"

namespace railcast {

/// Writes a capture or a bag as it was, by MakeCopyOutput(); null if the recording is neither. What
/// an interrupted run has written is made anew.
/// @param folder Where it is written.
[[nodiscard]] std::unique_ptr<RecordingOutput> MakeSameCopy(const RecordingInfo& info,
                                                            const std::filesystem::path& folder);

}  // namespace railcast
