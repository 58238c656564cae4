#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "railcast/io/recording.h"

namespace railcast {

/// The recording behind `railcast.Recording`: frames one after another or, where their number is
/// known, by their place. Thread-safe; frames are read and decoded at the same time.
class IndexedRecording {
 public:
  /// @throws InputError as OpenRecording().
  explicit IndexedRecording(std::filesystem::path source)
      : source_(std::move(source)), recording_(OpenRecording(source_)) {}

  [[nodiscard]] const std::filesystem::path& source() const { return source_; }
  [[nodiscard]] const RecordingInfo& info() const { return recording_->info(); }

  /// Returns the frame at a place, or nothing beyond the last one.
  /// @throws InputError if its file cannot be read or is damaged.
  [[nodiscard]] std::shared_ptr<RecordedFrame> At(std::size_t place) {
    std::optional<Recording::FrameReader> read;
    {
      const std::lock_guard lock(mutex_);
      while (readers_.size() <= place) {
        auto next = recording_->Next();
        if (!next) return nullptr;
        readers_.push_back(std::move(*next));
      }
      read = readers_[place];
    }
    return std::make_shared<RecordedFrame>((*read)());
  }

 private:
  std::filesystem::path source_;
  std::unique_ptr<Recording> recording_;
  std::mutex mutex_;
  std::vector<Recording::FrameReader> readers_;  // Of the frames so far.
};

/// One pass over a recording, which keeps nothing of the frames before.
class RecordingPass {
 public:
  explicit RecordingPass(const std::filesystem::path& source) : recording_(OpenRecording(source)) {}

  /// The next frame, or nothing at the end.
  [[nodiscard]] std::shared_ptr<RecordedFrame> Next() {
    const std::lock_guard lock(mutex_);
    const auto read = recording_->Next();
    return read ? std::make_shared<RecordedFrame>((*read)()) : nullptr;
  }

 private:
  std::unique_ptr<Recording> recording_;
  std::mutex mutex_;
};

}  // namespace railcast
