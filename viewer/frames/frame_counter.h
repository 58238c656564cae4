#pragma once

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <thread>

namespace railcast {

/// Counts the frames of a recording that does not know their number, on a thread of its own: reads
/// it once to its end or to where it is damaged, without making frames.
class FrameCounter {
 public:
  explicit FrameCounter(std::filesystem::path source);
  /// Counts no further.
  ~FrameCounter() = default;
  FrameCounter(const FrameCounter&) = delete;
  FrameCounter& operator=(const FrameCounter&) = delete;

  /// So far. Thread-safe.
  [[nodiscard]] std::size_t num_counted() const { return num_counted_; }

 private:
  void Count(const std::filesystem::path& source, const std::stop_token& stop);

  std::atomic<std::size_t> num_counted_{};
  std::jthread thread_;  ///< Ends before what it counts with.
};

}  // namespace railcast
