#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/frame/frame.h"
#include "generator/frame_record.h"
#include "generator/line_file.h"
#include "generator/object_record.h"
#include "generator/pose_record.h"
#include "generator/sequence_progress.h"
#include "generator/sequence_spec.h"

namespace railcast {

/// A directory that holds a sequence of frames, complete or under way.
///
/// Layout: `frames/NNNNNN.*` (kitti: KITTI's own, numbered from 0 because line n of poses.txt
/// belongs to file n), `poses.csv`, `objects.jsonl`, `frames.jsonl`, `scenario.resolved.json`,
/// `inputs/HASH/NAME` (the files that names), `labels.json`, `materials.json`, `commands.jsonl` (if
/// it replays any), `run.json` (whose run this is) and, once complete, `manifest.json`.
///
/// A frame counts as done when its line in frames.jsonl is whole and its files and lines have the
/// hashes that line names. Whatever else an interrupted run left behind is dropped on opening, so
/// that a resumed run gives the same bytes as one that was never interrupted.
class SequenceDirectory {
 public:
  /// Creates the directory, or opens it and finds out how far its run has come.
  /// @throws InputError if it belongs to another run, holds other things, is complete but was
  ///   changed since, is being written by another process, or the system refuses.
  explicit SequenceDirectory(SequenceSpec spec);
  ~SequenceDirectory();
  SequenceDirectory(const SequenceDirectory&) = delete;
  SequenceDirectory& operator=(const SequenceDirectory&) = delete;

  /// Whether manifest.json is there.
  [[nodiscard]] bool is_complete() const { return is_complete_; }
  [[nodiscard]] std::uint32_t num_done() const { return num_done_; }
  /// Of all frames done.
  [[nodiscard]] const FrameCounts& counts() const { return counts_; }

  /// Writes frame start_frame + num_done().
  /// @throws InputError if the system refuses; the directory can be resumed all the same.
  void Write(const Frame& frame, const std::vector<ObjectInFrame>& objects);

  /// Writes the manifest. @pre All frames are done.
  void Finish();

 private:
  void Open();
  // @throws InputError if the directory holds a file that is none of this run's.
  void RefuseStrangers(bool is_run) const;
  void RemoveUnfinished() const;
  void Resume();
  // Of a complete directory, whose frames were counted already.
  void CheckUnchanged(const SequenceProgress& progress) const;
  // All that is known before the first frame, but run.json.
  [[nodiscard]] std::vector<FrameFile> FixedFiles() const;
  void WriteFixedFiles();
  [[nodiscard]] std::string ManifestJson() const;
  [[nodiscard]] std::vector<std::string> RecordLines(const Frame& frame,
                                                     const std::vector<ObjectInFrame>& objects);

  SequenceSpec spec_;
  int lock_ = -1;
  bool is_complete_ = false;
  std::uint32_t num_done_ = 0;
  FrameCounts counts_;
  std::optional<PoseRecord> first_pose_;
  std::vector<LineFile> line_files_;  ///< frames.jsonl last: its line makes the frame count.
  std::vector<FrameFile> frame_files_;
};

}  // namespace railcast
