#pragma once

#include <filesystem>
#include <memory>

#include "core/io/recording/recording.h"

namespace railcast {

// What OpenRecording opens, by kind.

/// A directory that railcast-generate sequence made, finished or not: the frames whose lines in
/// frames.jsonl are whole.
/// @throws InputError if its scenario, labels or materials cannot be read.
[[nodiscard]] std::unique_ptr<Recording> OpenSequence(const std::filesystem::path& directory);

}  // namespace railcast
