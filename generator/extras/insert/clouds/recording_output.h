#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/io/run/fixed_file.h"
#include "generator/extras/insert/clouds/edit_rows.h"
#include "generator/extras/insert/insert_plan.h"
#include "generator/extras/insert/inserted_frame.h"
#include "generator/extras/insert/recorded_firings.h"
#include "generator/run/line_ledger.h"
#include "generator/run/run_directory.h"
#include "railcast/io/cloud_files.h"
#include "railcast/io/recording.h"

namespace railcast {

struct SequenceSummary;

/// What a frame adds to the recording that is written.
struct WrittenFrame {
  /// Files to write, relative to the folder of the recording.
  std::vector<FrameFile> files;
  std::vector<std::string> lines;  ///< One for each of RecordingOutput::LineFiles().
  /// For each point of the frame's cloud, in its order, the slot; kNoSlot for places in an
  /// organised cloud that belong to none.
  std::vector<std::uint32_t> slots;
  bool has_slots = true;                ///< Whether they are known before Write().
  std::string source_hash;              ///< ContentHash of the frame's source, if it is a file.
  std::optional<EncodedFrame> frame{};  ///< A frame of a sequence.
};

/// Writes frames that are made of those of a recording, one after another, into a folder.
class FolderOutput {
 public:
  virtual ~FolderOutput() = default;

  /// The files that get a line of each frame, with their headers; relative to the folder of the
  /// recording.
  [[nodiscard]] virtual std::vector<LineFileName> LineFiles() const { return {}; }
  [[nodiscard]] virtual std::vector<FixedFile> FixedFiles() const { return {}; }

  /// Begins, or goes on after an interruption.
  /// @param num_done How many frames an earlier run has written.
  /// @return How many of these are there and need not be written again.
  [[nodiscard]] virtual std::uint32_t Begin(std::uint32_t num_done) { return num_done; }
  virtual void Finish() {}
  /// The names of the files that hold more than a frame and are none of LineFiles() or
  /// FixedFiles(), as of a capture; not of a sequence, whose own manifest knows its files. After
  /// Finish().
  [[nodiscard]] virtual std::vector<std::string> WholeFiles() const { return {}; }
};

/// Writes the recording with what was inserted.
class RecordingOutput : public FolderOutput {
 public:
  /// Several threads may do so at once, and while one writes.
  /// @param frame Counted from 0 in the recording.
  [[nodiscard]] virtual WrittenFrame Encode(const RecordedFirings& firings,
                                            const InsertedFrame& inserted,
                                            std::uint32_t frame) const = 0;
  /// Writes what is not in WrittenFrame::files, of one frame after another, and sets
  /// WrittenFrame::slots where Encode() did not know them.
  virtual void Write(const RecordedFirings& /*firings*/,
                     const InsertedFrame& /*inserted*/,
                     WrittenFrame& /*output*/) {}
};

/// What the run of a recorded sequence was, but for its directory and frames.
[[nodiscard]] SequenceSpec SpecOfRecorded(const SequenceSummary& summary,
                                          const ScenarioSpec& scenario);

/// Whether points are in the sensor's axes, as recordings are read.
[[nodiscard]] inline bool IsInSensorAxes(const OutputSpec& output) {
  return output.frame == OutputFrame::kSensor && output.handedness == Handedness::kRight;
}

/// The frame as encoders expect it: with an outcome for each slot.
/// @param recorded Of which `frame` is taken.
[[nodiscard]] Frame WithOutcomes(const RecordedFrame& recorded);

/// The table for encoders, where labels are SemanticKITTI's numbers.
[[nodiscard]] LabelTable KittiNumbersIn(const Frame& frame);

/// Writes a recording of cloud files as it was; null if it is none. Beside some of its frames,
/// poses.txt and times.txt of KITTI have the lines of these.
/// @throws InputError if the recording has no number for a label of the plan's objects.
[[nodiscard]] std::unique_ptr<RecordingOutput> MakeSameClouds(const RecordingInfo& info,
                                                              const InsertPlan& plan,
                                                              const InsertRange& range);

/// Where a sequence is written, and what its certificates are about, if it has any.
struct SameSequenceChoices {
  std::filesystem::path folder;
  std::optional<CertifySpec> certify;
};

/// Writes a sequence of railcast as it was; null if the recording is none. Certificates are those
/// of what was put in; those that the recording has are left out.
/// @throws InputError if its clouds are not in files, or not in the sensor's axes, or as above.
[[nodiscard]] std::unique_ptr<RecordingOutput> MakeSameSequence(const RecordingInfo& info,
                                                                const InsertPlan& plan,
                                                                const InsertRange& range,
                                                                const SameSequenceChoices& choices);

/// Writes frames of any recording in a format of railcast's that has files for each frame: in
/// KITTI's layout, or as clouds with frames.csv where poses are known.
[[nodiscard]] std::unique_ptr<RecordingOutput> MakeConvertedClouds(const RecordingInfo& info,
                                                                   const InsertPlan& plan,
                                                                   const FrameFormat& format,
                                                                   std::uint32_t first_frame);

}  // namespace railcast
