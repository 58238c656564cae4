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
  /// What could not be compared with anything, and why: no faults.
  std::vector<std::string> unchecked{};
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

/// Whether a directory holds a run of several sensors, finished or not.
[[nodiscard]] bool IsOfSensors(const std::filesystem::path& directory);

/// Verifies the sequences of a run of several sensors and their merged clouds, compares
/// sensors.json with its own hash and with the sensors' manifests, and looks for files that belong
/// to none of them.
/// @param on_progress Called from time to time with the completed share.
[[nodiscard]] Verification VerifySensors(const std::filesystem::path& directory,
                                         const std::function<void(double)>& on_progress);

/// Verifies a folder of any kind that has records of its files (FindFolderKind()), but a study's.
/// @param on_progress Called from time to time with the completed share.
/// @throws InputError if the directory is none of these, or this build lacks the extra; of another
///   kind, "out/report: is a report, which keeps no hashes of its files: ...".
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
