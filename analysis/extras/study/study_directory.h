#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/extras/study/approach_record.h"
#include "core/extras/recipe/shard.h"
#include "core/io/run/folder_kind.h"
#include "core/io/run/run_folder.h"
#include "core/io/verify/verification.h"
#include "core/scenario/value_type.h"

namespace railcast {

/// The names of what its report writes into a study's folder.
inline constexpr const char* kFilesOfReport =
    R"(report\.(json|html)|csv/[^/]+\.csv|charts/[^/]+\.(svg|png))";

/// Which frames of each approach are made.
struct StudyFramesRecord {
  std::uint32_t first{};
  std::uint32_t stride{};
  std::uint32_t num{};
};
void Describe(Archive& a, StudyFramesRecord& s);

/// The content of study.json: everything that a study's figures depend on.
struct StudyRecord {
  std::string version;
  std::string embree;
  std::string isa;
  std::string study_hash;
  std::string recipe_hash;
  std::vector<std::string> base_hashes{};
  std::string files_hash{};  ///< Hash of the files that the recipe names.
  std::uint32_t num_scenarios{};
  StudyFramesRecord frames{};
  std::optional<double> certify{};  ///< Share of the time that certificates may take.
  std::string shard{};              ///< "2/7"; empty for a whole study.
  std::string rare{};               ///< The RareSpec as text; empty where none is asked for.
};
void Describe(Archive& a, StudyRecord& s);

/// Reads study.json of a folder.
/// @throws InputError if there is none, or if it is damaged.
[[nodiscard]] StudyRecord ReadStudyRecord(const std::filesystem::path& directory);

/// The content of manifest.json of a study.
struct StudyManifestRecord {
  NamedValues<std::string> files{};  ///< The hashes of all files.
};
void Describe(Archive& a, StudyManifestRecord& s);

/// A folder with a study, complete or unfinished: study.json says what its figures depend on, and
/// approaches.jsonl has a line for each approach that is done.
class StudyDirectory {
 public:
  /// Creates the folder, or opens it and finds out how far its run has got.
  /// @param identity Everything that the lines depend on, but for the shard.
  /// @throws InputError if it holds anything else, belongs to another study or shard, or is being
  ///   written by another process.
  StudyDirectory(std::filesystem::path directory, StudyRecord identity, const Shard& shard);

  /// Number of the shard's approaches that are done.
  [[nodiscard]] std::uint32_t num_done() const { return num_done_; }
  /// Adds the next record as a line.
  void Append(const std::string& record);
  /// Waits until all lines are on the disk.
  void Sync() { lines_->Sync(); }

  /// The approaches that are done.
  /// @throws InputError if a line is damaged.
  [[nodiscard]] std::vector<ApproachRecord> Read() const;

 private:
  std::filesystem::path directory_;
  Shard shard_;
  std::optional<FolderLock> lock_;
  std::optional<LineFile> lines_;
  std::uint32_t num_done_ = 0;
};

/// Reads the approaches of a folder that no process writes to.
/// @throws InputError if the file cannot be read, or "approaches.jsonl:3: rule" if a line is not as
///   it was written.
[[nodiscard]] std::vector<ApproachRecord> ReadApproaches(const std::filesystem::path& directory);

/// As AnalysisExtras::verify_study.
[[nodiscard]] Verification VerifyStudy(const std::filesystem::path& directory,
                                       const std::function<void(double)>& on_progress);

/// Puts the approaches of all shards of a study into one folder.
/// @param identity As of StudyDirectory.
/// @throws InputError if a shard is missing, incomplete, there twice or of another study.
void MergeStudies(const std::vector<std::filesystem::path>& shards,
                  const StudyRecord& identity,
                  StudyDirectory& into);

}  // namespace railcast
