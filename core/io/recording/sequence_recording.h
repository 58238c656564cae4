#pragma once

#include <filesystem>
#include <memory>

#include "core/io/recording/recording.h"

namespace railcast {

// What OpenRecording opens, by kind.

/// A directory that railcast-generate sequence made, finished or not: the frames whose lines in
/// frames.jsonl are whole. Every file and line is checked against the hash that it was written
/// with, a frame's when it is read.
/// @throws InputError with one line if a file cannot be read or is not as it was written.
[[nodiscard]] std::unique_ptr<Recording> OpenSequence(const std::filesystem::path& directory);

}  // namespace railcast
