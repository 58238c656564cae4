#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/io/run/dataset_files.h"
#include "core/io/run/insert_record.h"
#include "core/io/run/run_folder.h"
#include "generator/insert/clouds/recording_output.h"
#include "generator/run/line_ledger.h"
#include "railcast/io/cloud_files.h"

namespace railcast {

/// What a folder of inserted frames is of.
struct InsertFolderSpec {
  std::filesystem::path directory;
  InsertRunRecord run;
  /// Those that get a line of each frame, without insert.jsonl.
  std::vector<LineFileName> line_files;
  bool is_known = false;  ///< Whether the folder is known to be of this run, whatever it says.
};

/// The folder that `insert --out` names, complete or unfinished. A frame counts as done when its
/// line in insert.jsonl is whole and its files and lines have the hashes that this line states.
/// What else an interrupted run has left is written again.
class InsertFolder {
 public:
  /// Makes the folder, or opens it and finds out how far its run has got. If a complete one is not
  /// as it was written, it can be gone on with: what differs is made anew.
  /// @throws InputError if it holds another run or other files, is being written by another
  ///   process, or the system refuses.
  explicit InsertFolder(InsertFolderSpec spec);

  [[nodiscard]] bool is_complete() const { return is_complete_; }
  [[nodiscard]] std::uint32_t num_done() const { return num_done_; }
  /// What was not as it was written when a complete folder was opened, a line each.
  [[nodiscard]] const std::vector<std::string>& changed() const { return changed_; }

  /// Keeps the lines of the first frames and opens the files for those after them.
  void Open(std::uint32_t num_kept);
  /// Writes a file that is known before the first frame, unless it is there already.
  void WriteFixed(const FixedFile& file);
  /// Writes the next frame.
  /// @param lines One for each of the spec's files.
  /// @param entry The frame's line in insert.jsonl, but for its files and the hash of `lines`.
  void Write(const std::vector<FrameFile>& files,
             const std::vector<std::string>& lines,
             InsertRecord entry);
  /// Removes what was written if no frame was: a plan that does not fit its recording leaves
  /// nothing that keeps a mended one from being run.
  void Abandon() noexcept;
  /// Writes the manifest: the members of run.json, remarks, and the hashes of all files but those
  /// of frames, which insert.jsonl names.
  /// @param others Names of files that were written by others.
  void Finish(const std::vector<std::string>& remarks, const std::vector<std::string>& others);

 private:
  void RemoveUnfinished(const std::vector<std::string>& own) const;

  InsertFolderSpec spec_;
  FolderLock lock_;
  bool was_empty_ = false;
  bool is_complete_ = false;
  std::uint32_t num_done_ = 0;
  std::vector<std::string> changed_;
  LineLedger lines_;  ///< insert.jsonl is last.
  std::vector<std::string> fixed_;
};

}  // namespace railcast
