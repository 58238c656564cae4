#pragma once

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <thread>

namespace railcast {

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

}  // namespace railcast
