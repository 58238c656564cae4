#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <memory>
#include <optional>

#include "viewer/frames/frame_counter.h"
#include "viewer/frames/frame_shelf.h"
#include "viewer/frames/frames.h"

namespace railcast {

/// The frames of a recording, in any order.
class RecordedFrames final : public Frames {
 public:
  /// @param source As OpenRecording() takes it. A single file of a sequence has the sequence's
  ///   labels.
  /// @throws InputError with one line if it cannot be opened.
  explicit RecordedFrames(const std::filesystem::path& source);

  /// The last frames asked for are kept.
  [[nodiscard]] std::shared_ptr<const ShownFrame> Get(std::size_t place) override;

  /// The place of the frame of that number in its run (Frame::index): a sequence need not begin
  /// with 0.
  /// @throws InputError with one line if there is none.
  [[nodiscard]] std::size_t PlaceOf(std::uint32_t frame_index);

  /// Of a capture, whose frames are counted beside, it rises up to their number.
  [[nodiscard]] std::size_t num_known() const override;
  /// Reads on to the end.
  void SeekEnd();

 private:
  void Reopen();
  /// Passes one frame's reader on the way; false at the end.
  bool Advance();

  std::unique_ptr<Recording> recording_;
  /// Of frames [first_reader_, first_reader_ + readers_.size()): the last that were passed. To go
  /// farther back means to read the recording anew.
  std::deque<Recording::FrameReader> readers_;
  std::size_t first_reader_{};
  std::size_t num_passed_{};  ///< As far as readers ever were; of most recordings all.
  bool is_end_known_ = false;
  FrameShelf kept_{FrameShelf::Limits{}};
  std::optional<FrameCounter> counter_;  ///< If the recording does not say how many there are.
};

}  // namespace railcast
