#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/extras/insert/convert_record.h"
#include "core/extras/ros/bag/bag.h"
#include "core/extras/ros/messages/frame_topics.h"
#include "core/extras/ros/messages/sensor_messages.h"
#include "core/io/cloud/cloud.h"
#include "generator/extras/convert/convert.h"
#include "generator/extras/insert/clouds/recording_output.h"
#include "generator/extras/insert/plan/pose_file.h"
#include "generator/run/line_ledger.h"
#include "railcast/io/recording.h"

namespace railcast {

/// A frame of a recording, and its points as they are stored.
struct SourceFrame {
  RecordedFrame recorded;
  Cloud cloud;  ///< The points as they are packed.
  // What the message says, if the cloud is one:
  std::string topic{};
  std::optional<ros::Header> header{};
};

/// Reads the frames of a recording with their clouds. Where these are in files or messages of their
/// own, they keep their fields, types and order; else they have what is known of the frame. Those
/// of KITTI have the poses and times that stand beside them.
class SourceFrames {
 public:
  /// @throws InputError as OpenRecording() and ReadKittiPoses() do.
  explicit SourceFrames(const std::filesystem::path& recording);

  [[nodiscard]] const RecordingInfo& info() const { return recording_->info(); }
  /// Returns the reader of the next frame, which any thread may call; nothing at the end.
  /// @throws InputError as Recording::Next() does; so does the reader.
  [[nodiscard]] std::optional<std::function<SourceFrame()>> Next();

 private:
  std::unique_ptr<Recording> recording_;
  std::vector<std::filesystem::path> files_;  ///< For clouds in files.
  std::string kitti_columns_;
  KittiPoses kitti_;
  std::size_t next_ = 0;
  std::unique_ptr<bag::BagReader> bag_;  ///< For clouds in messages.
  std::string bag_series_;
};

/// What is known of the frames that are written before the first of them is.
struct SourceSurvey {
  InsertRange range;
  SourceFrame first;  ///< Says what the recording has.
  // Known only for the format of a data set, which needs it:
  bool has_poses = true;    ///< Whether all frames have one.
  bool has_stamps = false;  ///< Whether the stamp of any is not 0.
};

/// What becomes of a frame.
struct ConvertedFrame {
  std::vector<FrameFile> files;
  std::vector<std::string> lines;           ///< One for each of FolderOutput::LineFiles().
  std::vector<ros::TopicMessage> messages;  ///< For bags.
  ConvertRecord record;
};

/// Writes the frames of a recording in a format.
class ConvertOutput : public FolderOutput {
 public:
  /// Fills `files`, `lines`, `messages`, and what is lost. Several threads may do so at once.
  /// @param number Of the frame in the recording.
  virtual void Encode(const SourceFrame& source,
                      std::uint32_t number,
                      ConvertedFrame& frame) const = 0;
  /// Writes the messages of one frame after another.
  virtual void Write(const ConvertedFrame& /*frame*/) {}
  /// What is lost of the recording as a whole.
  [[nodiscard]] virtual Losses LostOfAll() const { return {}; }
};

/// @throws InputError if the format has no place for the points, or the recording lacks a field.
[[nodiscard]] std::unique_ptr<ConvertOutput> MakeConvertOutput(const ConvertChoices& choices,
                                                               const RecordingInfo& info,
                                                               const SourceSurvey& survey);

/// The output of a bag.
/// @param names Of the chosen fields; empty: all, or a layout is chosen.
[[nodiscard]] std::unique_ptr<ConvertOutput> MakeConvertedBag(const ConvertChoices& choices,
                                                              const RecordingInfo& info,
                                                              const std::vector<std::string>& names,
                                                              const SourceSurvey& survey);

/// The cloud with the chosen fields that the format holds; empty names: all.
[[nodiscard]] Cloud CloudFor(const FrameFormat& format,
                             const SourceFrame& source,
                             const std::vector<std::string>& names,
                             Losses& lost);

}  // namespace railcast
