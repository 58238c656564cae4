#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/io/ros/frame_topics.h"
#include "core/io/run/convert_record.h"
#include "generator/convert/convert.h"
#include "generator/convert/source_frames.h"
#include "generator/insert/clouds/recording_output.h"
#include "generator/run/line_ledger.h"

namespace railcast {

/// What becomes of a frame.
struct ConvertedFrame {
  std::vector<FrameFile> files;
  std::vector<std::string> lines;           ///< One for each of ConvertOutput::LineFiles().
  std::vector<ros::TopicMessage> messages;  ///< Of bags.
  ConvertRecord record;
};

/// Writes the frames of a recording in a format.
class ConvertOutput {
 public:
  virtual ~ConvertOutput() = default;

  /// The files that get a line of each frame, with their headers.
  [[nodiscard]] virtual std::vector<LineFileName> LineFiles() const { return {}; }
  [[nodiscard]] virtual std::vector<FixedFile> FixedFiles() const { return {}; }
  /// Begins, or goes on after an interruption.
  /// @param num_done How many of the `num_frames` an earlier run has written.
  /// @return How many of these are there.
  [[nodiscard]] virtual std::uint32_t Begin(std::uint32_t num_done, std::uint32_t /*num_frames*/) {
    return num_done;
  }
  /// Fills `files`, `lines`, `messages`, and what is lost. Several threads may do so at once.
  /// @param number Of the frame in the recording.
  virtual void Encode(const SourceFrame& source,
                      std::uint32_t number,
                      ConvertedFrame& frame) const = 0;
  /// Writes the messages of one frame after another.
  virtual void Write(const ConvertedFrame& /*frame*/) {}
  virtual void Finish() {}
  /// The names of the files that hold more than a frame, after Finish().
  [[nodiscard]] virtual std::vector<std::string> WholeFiles() const { return {}; }
  /// What is lost of the recording as a whole.
  [[nodiscard]] virtual Losses LostOfAll() const { return {}; }
};

/// @param first The first frame that is written, which says what the recording has.
/// @throws InputError if the format has no place for the points, or the recording lacks a field.
[[nodiscard]] std::unique_ptr<ConvertOutput> MakeConvertOutput(const ConvertChoices& choices,
                                                               const RecordingInfo& info,
                                                               const SourceFrame& first);

/// The output of a bag.
/// @param names Of the chosen fields; empty: all, or a layout is chosen.
[[nodiscard]] std::unique_ptr<ConvertOutput> MakeConvertedBag(const ConvertChoices& choices,
                                                              const RecordingInfo& info,
                                                              const std::vector<std::string>& names,
                                                              const SourceFrame& first);

/// The cloud with the chosen fields that the format holds; empty names: all.
[[nodiscard]] Cloud CloudFor(const FrameFormat& format,
                             const SourceFrame& source,
                             const std::vector<std::string>& names,
                             Losses& lost);

}  // namespace railcast
