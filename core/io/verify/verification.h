#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace railcast {

/// Result of verifying a sequence directory.
struct Verification {
  std::vector<std::string> faults;  ///< Each on one line: "file: rule (got value)".
  std::uint64_t num_frames{};       ///< Frames that have a line in frames.jsonl.
  std::uint64_t num_files{};        ///< Files that were read.
  std::uint64_t num_bytes{};        ///< Size of these files.
};

/// Compares every file of a sequence directory with run.json, manifest.json and frames.jsonl, and
/// looks for files that these do not name. A directory without a manifest, left by an unfinished
/// run, is checked as far as possible; the missing manifest is a fault.
/// @param on_progress Called from time to time with the completed share.
/// @throws InputError if the directory was not made by railcast-generate sequence.
[[nodiscard]] Verification VerifySequence(const std::filesystem::path& directory,
                                          const std::function<void(double)>& on_progress);

/// Refuses a complete folder that is not as its command wrote it, and says how it is mended.
/// @throws InputError with a line for each fault, and one more.
void RefuseChanged(const std::filesystem::path& directory, const Verification& found);

}  // namespace railcast
