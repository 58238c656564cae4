#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace railcast {

/// Callbacks of a run of frames.
struct RunHooks {
  /// Called after every frame and once before the first, by one thread at a time.
  std::function<void(std::uint32_t num_done, std::uint32_t num_frames)> on_progress;
  /// Called before every frame, and by several threads at once where a scene is built or clouds are
  /// merged; if it returns true, the run ends after the frames under way.
  std::function<bool()> is_stopped;
};

/// How far a run of frames has got.
struct RunResult {
  std::uint32_t num_resumed{};  ///< Frames made by an earlier run.
  std::uint32_t num_done{};     ///< All frames in the directory.
  bool was_complete{};          ///< All frames were there before.
  /// What was not as it was written in a complete directory and was made anew, a line each.
  std::vector<std::string> changed{};
  bool is_complete{};  ///< All frames and the manifest are there.
};

/// The way of frames from where they begin to where they are kept, on which there are several at
/// once. Each has a slot, a number whose memory belongs to the caller and to later frames, too. It
/// is begun in its turn, goes through the stages, and is written in its turn.
struct FramePipe {
  struct Stage {
    bool is_in_order{};  ///< One frame after another; otherwise several at once.
    std::function<void(std::size_t slot)> work;
  };

  /// How many frames are in the stages at once.
  std::size_t num_at_once = 1;
  /// How many more may wait to be written or are being written; at least 1.
  std::size_t num_waiting = 1;
  [[nodiscard]] std::size_t num_slots() const { return num_at_once + num_waiting; }

  /// Calls a function on the run's threads, which TBB's algorithms within it use.
  std::function<void(const std::function<void()>& work)> execute;
  /// Begins the next frame. Returns false if there is none left.
  std::function<bool(std::size_t slot)> begin;
  std::vector<Stage> stages;
  /// Called on a thread of its own, so that a disk that pauses holds up none that makes frames.
  std::function<void(std::size_t slot)> write;
  /// Called for each frame that was written, by one thread at a time.
  std::function<void()> on_written;
};

/// Lets frames go their way until there is none left. If one cannot be made, those before it are
/// written before the exception is passed on. RunStopped ends the way like that, too, but is not
/// passed on. Nothing is written after what could not be written.
void RunPipe(const FramePipe& pipe);

}  // namespace railcast
