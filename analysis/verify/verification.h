#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace railcast {

/// What was found of a sequence directory.
struct Verification {
  std::vector<std::string> faults;  ///< "file: rule (got value)", each on one line.
  std::uint64_t num_frames{};       ///< That have a line in frames.jsonl.
  std::uint64_t num_files{};        ///< That were read.
  std::uint64_t num_bytes{};        ///< Of these.
};

/// Compares every file of a sequence directory with what run.json, manifest.json and frames.jsonl
/// say of it, and looks for files that they do not name. A directory without a manifest, of an
/// unfinished run, is checked as far as it goes; that it has none is a fault.
/// @param on_progress Told from time to time which share is done.
/// @throws InputError if the directory is none that railcast-generate sequence made.
[[nodiscard]] Verification VerifySequence(const std::filesystem::path& directory,
                                          const std::function<void(double)>& on_progress);

}  // namespace railcast
