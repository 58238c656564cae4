#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace railcast {

struct MergedFolder;

/// Result of verifying a sequence directory.
struct Verification {
  /// A file that does not belong there, which is a fault, too.
  struct OtherFile {
    std::filesystem::path file;
    std::string fault;
    bool is_unfinished{};  ///< Whether an interrupted run has left it beside the finished file.
  };

  std::vector<std::string> faults;  ///< Each on one line: "file: rule (got value)".
  std::vector<OtherFile> others{};
  std::uint64_t num_frames{};  ///< Frames that have a line in frames.jsonl.
  std::uint64_t num_files{};   ///< Files that were read.
  std::uint64_t num_bytes{};   ///< Size of these files.
};

/// Compares every file of a sequence directory with run.json, manifest.json and frames.jsonl, and
/// looks for files that these do not name. A directory without a manifest, left by an unfinished
/// run, is checked as far as possible; the missing manifest is a fault.
/// @param on_progress Called from time to time with the completed share.
/// @throws InputError if the directory was not made by railcast-generate sequence.
[[nodiscard]] Verification VerifySequence(const std::filesystem::path& directory,
                                          const std::function<void(double)>& on_progress);

/// Compares the merged clouds of several sensors with merged.jsonl, this with sensors.json, and
/// looks for files that neither names.
/// @param on_progress Called from time to time with the completed share.
[[nodiscard]] Verification VerifyMerged(const MergedFolder& merged,
                                        const std::function<void(double)>& on_progress);

/// Verifies what VerifySequence() does, or the folder of an extra's command.
/// @param on_progress Called from time to time with the completed share.
/// @throws InputError if the directory is none of these, or this build lacks the extra.
[[nodiscard]] Verification VerifyFolder(const std::filesystem::path& directory,
                                        const std::function<void(double)>& on_progress);

/// What the command that made a complete folder does as it finds it again: removes what an
/// interrupted run has left, and refuses files of others.
/// @return The other faults; what they name must be made anew.
/// @throws InputError "DIR: holds a file that does not belong to this run (notes.txt); ...".
[[nodiscard]] std::vector<std::string> FaultsToMend(const std::filesystem::path& directory,
                                                    const Verification& found);

/// Whether a directory holds a survey, as railcast-generate survey makes it.
[[nodiscard]] bool IsSurvey(const std::filesystem::path& directory);

/// Compares the files of such a directory with survey.json, and looks for files that it does not
/// name.
/// @throws InputError if the directory cannot be read.
[[nodiscard]] Verification VerifySurvey(const std::filesystem::path& directory);

}  // namespace railcast
