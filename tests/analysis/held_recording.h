#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "railcast/io/recording.h"

namespace railcast {

/// A recording whose frames are held in memory.
class HeldRecording final : public Recording {
 public:
  explicit HeldRecording(std::vector<RecordedFrame> frames) : frames_(std::move(frames)) {}

  [[nodiscard]] const RecordingInfo& info() const override { return info_; }
  [[nodiscard]] std::optional<FrameReader> Next() override {
    if (next_ == frames_.size()) return std::nullopt;
    return [&frame = frames_[next_++]] { return frame; };
  }

 private:
  RecordingInfo info_;
  std::vector<RecordedFrame> frames_;
  std::size_t next_ = 0;
};

}  // namespace railcast
