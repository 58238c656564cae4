#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/io/record/record_text.h"
#include "core/io/run/frame_record.h"
#include "core/io/run/run_folder.h"
#include "core/io/run/run_record.h"
#include "core/io/run/sequence_files.h"
#include "core/io/write_file.h"
#include "core/scenario/value_type.h"
#include "generator/extras/insert/clouds/recording_output.h"
#include "generator/run/frame_pipe.h"
#include "generator/run/line_ledger.h"
#include "railcast/io/cloud_files.h"

namespace railcast {

/// What a folder of frames that are made of those of a recording is of.
struct FrameFolderSpec {
  std::filesystem::path directory;
  std::string made;  ///< As messages name it: "an insertion".
  std::string run;   ///< The text of run.json.
  std::uint32_t first_frame{};
  std::uint32_t num_frames{};
  /// The files that get a line of each frame, without the ledger.
  std::vector<LineFileName> line_files;
  /// The file whose lines make frames count as done: insert.jsonl or convert.jsonl.
  std::string ledger;
  bool is_known = false;  ///< Whether the folder is known to be of this run, whatever it says.
};

/// Which frames of a recording are still to be made into others, and who is told.
struct MissingFrames {
  InsertRange range;         ///< All that are wanted, numbered as in the recording.
  std::uint32_t num_done{};  ///< How many of these are there.
  int num_threads{};         ///< 0 = one for each core.
  const RunHooks& hooks;
};

/// Lets the missing frames go through a pipe (FramePipe) whose slots are numbered from 0.
/// @param resize Makes memory for so many slots.
/// @param take Reads the recording's next frame, of this number, into a slot; returns false at its
///   end. The frames before the missing ones are taken, too.
void MakeMissing(const MissingFrames& missing,
                 const std::function<void(std::size_t num_slots)>& resize,
                 const std::function<bool(std::size_t slot, std::uint32_t number)>& take,
                 std::vector<FramePipe::Stage> stages,
                 std::function<void(std::size_t slot)> write);

/// The folder that `insert` or `convert` writes, complete or unfinished. A frame counts as done
/// when its line in the ledger is whole and its files and lines have the hashes that this line
/// states. What else an interrupted run has left is written again.
class FrameFolder {
 public:
  /// Makes the folder, or opens it and finds out how far its run has got. If a complete one is not
  /// as it was written, it can be gone on with: what differs is made anew.
  /// @throws InputError if it holds another run or other files, is being written by another
  ///   process, or the system refuses.
  explicit FrameFolder(FrameFolderSpec spec);

  [[nodiscard]] const std::filesystem::path& directory() const { return spec_.directory; }
  [[nodiscard]] bool is_complete() const { return is_complete_; }
  [[nodiscard]] std::uint32_t num_done() const { return num_done_; }

  /// Begins the output, or goes on with it, and has the frames made that the folder lacks.
  /// @param write_fixed Calls WriteFixed() for all that is known before the first frame.
  /// @param make_frames Calls Write(). If it throws, the output is closed and, if no frame was
  ///   written, the folder removed: a plan that does not fit its recording leaves nothing that
  ///   keeps a mended one from being run.
  template <typename Output>
  [[nodiscard]] RunResult Fill(std::unique_ptr<Output>& output,
                               const std::function<void()>& write_fixed,
                               const std::function<void()>& make_frames) {
    RunResult result{.num_resumed = num_done_, .was_complete = is_complete_, .changed = changed_};
    if (!is_complete_) {
      result.num_resumed = output->Begin(num_done_);
      Open(result.num_resumed);
      write_fixed();
      try {
        make_frames();
      } catch (...) {
        output.reset();
        Abandon();
        throw;
      }
    }
    result.num_done = num_done_;
    return result;
  }
  /// Writes a file that is known before the first frame, unless it is there already.
  void WriteFixed(const FixedFile& file);
  /// Writes the next frame.
  /// @param lines One for each of the spec's files.
  /// @param entry The frame's line in the ledger, a record whose member `frame` is a FrameRecord;
  ///   its files and the hash of `lines` are set.
  template <typename Entry>
  void Write(const std::vector<FrameFile>& files,
             const std::vector<std::string>& lines,
             Entry entry) {
    WriteFiles(files);
    entry.frame.files = KnownFilesOf(files);
    lines_.Append(lines, [&](std::string records_hash) {
      entry.frame.records_hash = std::move(records_hash);
      return HashedRecordLine(entry);
    });
    ++num_done_;
  }
  /// Writes the manifest.
  /// @param manifest Its record, whose member `files` gets the hashes of all files but those of
  ///   frames, which the ledger names.
  /// @param others Names of files that were written by others.
  template <typename Manifest>
  void Finish(Manifest manifest, const std::vector<std::string>& others) {
    manifest.files = HashesOfWhole(others);
    WriteFileWhole(spec_.directory / kManifestFile, WithManifestHash(RecordFile(manifest)));
    is_complete_ = true;
  }

 private:
  /// Counts the first frames that are done.
  void CountFrames(std::uint32_t most);
  /// Keeps the lines of the first frames and opens the files for those after them.
  void Open(std::uint32_t num_kept);
  /// Removes what was written if no frame was.
  void Abandon() noexcept;
  void WriteFiles(const std::vector<FrameFile>& files) const;
  [[nodiscard]] NamedValues<std::string> HashesOfWhole(const std::vector<std::string>& others);
  void RemoveUnfinished(const std::vector<std::string>& own) const;

  FrameFolderSpec spec_;
  FolderLock lock_;
  bool was_empty_ = false;
  bool is_complete_ = false;
  std::uint32_t num_done_ = 0;
  std::vector<std::string> changed_;  ///< What was not as it was written, a line each.
  LineLedger lines_;                  ///< The ledger is last.
  std::vector<std::string> fixed_;
};

}  // namespace railcast
