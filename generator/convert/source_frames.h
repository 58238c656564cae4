#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/io/bag/bag.h"
#include "core/io/cloud/cloud.h"
#include "railcast/io/recording.h"

namespace railcast {

/// A frame of a recording, and its points as they are stored.
struct SourceFrame {
  RecordedFrame recorded;
  Cloud cloud;  ///< Of packed points.
  /// The message's, if the cloud is one.
  std::optional<std::int64_t> message_stamp_ns{};
};

/// Reads the frames of a recording with their clouds. Where these are in files or messages of their
/// own, they keep their fields, types and order; else they have what is known of the frame.
class SourceFrames {
 public:
  /// @throws InputError as OpenRecording() does.
  explicit SourceFrames(const std::filesystem::path& recording);

  [[nodiscard]] const RecordingInfo& info() const { return recording_->info(); }
  /// Returns the reader of the next frame, which any thread may call; nothing at the end.
  /// @throws InputError as Recording::Next() does; so does the reader.
  [[nodiscard]] std::optional<std::function<SourceFrame()>> Next();

 private:
  std::unique_ptr<Recording> recording_;
  std::vector<std::filesystem::path> files_;  ///< Of clouds in files.
  std::string kitti_columns_;
  std::size_t next_ = 0;
  std::unique_ptr<bag::BagReader> bag_;  ///< Of clouds in messages.
};

/// The cloud with some of its fields, in its order and without what stands between them.
[[nodiscard]] Cloud WithFields(const Cloud& cloud, const std::vector<std::string>& names);

}  // namespace railcast
