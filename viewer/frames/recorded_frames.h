#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <memory>
#include <optional>
#include <thread>

#include "railcast/frame.h"
#include "railcast/io/recording.h"
#include "viewer/frames/frames.h"
#include "viewer/frames/shown_frame.h"

namespace railcast {

/// Returns the meaning of a recording's label numbers: from its own table, or from a labels.json
/// near its files. That may be in the directory or beside the file, or beside the frames/ that the
/// source is or lies in; for KITTI clouds, up to beside sequences/00/velodyne/. Empty if there is
/// none.
/// @throws InputError with one line if the labels.json is damaged.
[[nodiscard]] LabelTable LabelsOf(const RecordingInfo& info);

/// Counts the frames of a recording of unknown length on a thread of its own: reads it once, to its
/// end or to the first damage, without making frames.
class FrameCounter {
 public:
  explicit FrameCounter(std::filesystem::path source);
  /// Stops counting.
  ~FrameCounter() = default;
  FrameCounter(const FrameCounter&) = delete;
  FrameCounter& operator=(const FrameCounter&) = delete;

  /// Returns the number of frames counted so far. Thread-safe.
  [[nodiscard]] std::size_t num_counted() const { return num_counted_; }

 private:
  void Count(const std::filesystem::path& source, const std::stop_token& stop);

  std::atomic<std::size_t> num_counted_{};
  /// The last member, so that the thread ends before what it uses is destroyed.
  std::jthread thread_;
};

/// The frames of a recording, in any order.
class RecordedFrames final : public Frames {
 public:
  /// @param source As OpenRecording() takes it. A single file of a sequence has the labels of the
  ///   sequence.
  /// @throws InputError with one line if it cannot be opened.
  explicit RecordedFrames(const std::filesystem::path& source);

  /// The frames used last are kept.
  [[nodiscard]] std::shared_ptr<const ShownFrame> Get(std::size_t place) override;

  [[nodiscard]] std::shared_ptr<const CameraPicture> Picture(std::size_t place,
                                                             PictureKind kind) override {
    return pictures_.At(place, kind);
  }

  /// Returns the place of the frame with that number in its run (Frame::index), because a sequence
  /// need not begin with 0.
  /// @throws InputError with one line if there is none.
  [[nodiscard]] std::size_t PlaceOf(std::uint32_t frame_index);

  /// For a capture, whose frames are counted in the background, this rises up to their number.
  [[nodiscard]] std::size_t num_known() const override;
  /// Reads on to the end.
  void SeekEnd();

 private:
  void Reopen();
  /// Reads on by one frame and keeps its reader; returns false at the end.
  bool Advance();

  std::unique_ptr<Recording> recording_;
  /// Readers of frames [first_reader_, first_reader_ + readers_.size()), the last that were passed.
  /// To go back farther, the recording is read again from its beginning.
  std::deque<Recording::FrameReader> readers_;
  std::size_t first_reader_{};
  std::size_t num_passed_{};  ///< Number of frames passed so far; for most recordings, all.
  bool is_end_known_ = false;
  FrameShelf kept_{FrameShelf::Limits{}};
  RecordedPictures pictures_;
  /// Only if the recording does not say how many frames it has.
  std::optional<FrameCounter> counter_;
};

}  // namespace railcast
