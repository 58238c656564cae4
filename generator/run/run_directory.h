#pragma once

#include <any>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/certify/certified_figures.h"
#include "core/io/run/fixed_file.h"
#include "core/io/run/frame_record.h"
#include "core/io/run/run_folder.h"
#include "generator/run/frame_maker.h"
#include "generator/run/line_ledger.h"
#include "generator/run/run_extras.h"
#include "generator/run/run_plan.h"
#include "railcast/frame.h"

namespace railcast {

/// Returns run.json, which identifies the run of a directory from its first moment on.
[[nodiscard]] std::string RunJson(const SequenceSpec& spec);

/// Checks that the directory, which holds a run.json, belongs to this run.
/// @throws InputError that names the first difference if it is another run's.
/// @param is_complete Whether that run is complete, so that it cannot be continued.
void CheckIsSameRun(const SequenceSpec& spec, bool is_complete);

/// A frame as it is written to a sequence directory.
struct EncodedFrame {
  std::vector<FrameFile> files;
  std::any output;            ///< For the run's bag, if there is one.
  std::string trace_message;  ///< For the sequence's trace, if there is one.
  FrameRecord record;         ///< Without records_hash.
  PoseRecord pose;
  std::string objects_line;
  std::vector<std::string> motion_lines;  ///< For each motion sensor.
};

/// A directory that holds a sequence of frames, complete or unfinished.
///
/// Layout: `frames/NNNNNN.*` (kitti: KITTI's own layout, numbered from 0 because line n of
/// poses.txt belongs to file n), `poses.csv`, `objects.jsonl`, `frames.jsonl`,
/// `scenario.resolved.json`, `inputs/HASH/NAME` (the files that the scenario names), `labels.json`,
/// `materials.json`, `camera/NAME/...` (if there is a camera), `motion/NAME.csv` (for each motion
/// sensor), `commands.jsonl` (if the run replays any), the trace (if the format is one),
/// `run.json` (identifies the run) and, once complete, `manifest.json`.
///
/// A frame counts as done when its line in frames.jsonl is whole and its files, its lines and its
/// message in the trace have the hashes that this line states. All other remains of an interrupted
/// run are dropped on opening, so that a resumed run gives the same bytes as one that was never
/// interrupted.
class RunDirectory {
 public:
  /// Creates the directory, or opens it and finds out how far its run has got. If a complete one is
  /// not as it was written, it can be gone on with: what differs is made anew.
  /// @pre The directory is locked (FolderLock).
  /// @throws InputError if it belongs to another run, holds other files, or the system refuses.
  /// @param most_done Frames after these are made anew, even if they are there.
  explicit RunDirectory(SequenceSpec spec,
                        std::uint32_t most_done = std::numeric_limits<std::uint32_t>::max());
  ~RunDirectory() = default;
  RunDirectory(const RunDirectory&) = delete;
  RunDirectory& operator=(const RunDirectory&) = delete;

  /// Whether manifest.json exists.
  [[nodiscard]] bool is_complete() const { return is_complete_; }
  [[nodiscard]] std::uint32_t num_done() const { return num_done_; }
  /// What was not as it was written when a complete directory was opened, a line each.
  [[nodiscard]] const std::vector<std::string>& changed() const { return changed_; }
  /// Counts over all frames done.
  [[nodiscard]] const FrameCounts& counts() const { return counts_; }
  /// The numerical error of all frames done; absent if the run is not certified.
  [[nodiscard]] std::optional<RunCertificate> certificate() const;

  /// Encodes one of the run's frames. Several threads may do so at once, and while one writes.
  /// @param encoded Its memory is reused.
  void Encode(const MadeFrame& made, EncodedFrame& encoded) const;

  /// Writes the next of the run's frames.
  /// @throws InputError if the system refuses; the directory can be resumed nevertheless.
  void Write(const EncodedFrame& frame);

  /// Writes the manifest.
  /// @pre All frames are done.
  void Finish();

 private:
  // Removes what an interrupted run has left.
  // @throws InputError if the directory holds a file that does not belong to this run.
  void CheckNames(bool is_run) const;
  // Counts the first frames that are done, with their messages in the trace.
  void CountFrames();
  void OpenTrace();
  void AddRecord(const FrameRecord& record);
  // Compares a complete directory with what was written; empty if nothing has changed.
  [[nodiscard]] std::string WhatChanged() const;
  // Returns the files that are known before the first frame, run.json first.
  [[nodiscard]] std::vector<FixedFile> FixedFiles() const;
  void WriteFixedFiles();
  [[nodiscard]] std::string ManifestJson() const;
  [[nodiscard]] std::vector<std::string> RecordLines(const EncodedFrame& frame);

  SequenceSpec spec_;
  std::uint32_t most_done_;
  bool is_complete_ = false;
  std::vector<std::string> changed_;
  std::uint32_t num_done_ = 0;
  FrameCounts counts_;
  std::optional<CertificateSums> certificates_;  ///< If the run is certified.
  std::optional<PoseRecord> first_pose_;
  LineLedger lines_;                      ///< frames.jsonl is last.
  std::unique_ptr<SequenceTrace> trace_;  ///< Null = none.
};

}  // namespace railcast
