#pragma once

#include <sys/types.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include "generator/python/rail_lines.h"
#include "generator/run/frame_maker.h"
#include "railcast/frame.h"
#include "railcast/io/recording.h"
#include "railcast/scenario.h"
#include "railcast/simulator.h"

namespace railcast {

/// Hands out frames whose memory is used again when Python has dropped the frame and all arrays of
/// it: the system would otherwise clear fresh pages for every frame, which takes a tenth of the
/// time of a fast scan. Thread-safe.
class FramePool : public std::enable_shared_from_this<FramePool> {
 public:
  [[nodiscard]] static std::shared_ptr<FramePool> Make() { return std::make_shared<FramePool>(); }

  /// Returns a frame with the contents of whichever frame was dropped last, or an empty one.
  [[nodiscard]] std::shared_ptr<RecordedFrame> Take() {
    std::unique_ptr<RecordedFrame> frame;
    {
      const std::lock_guard lock(mutex_);
      if (!free_.empty()) {
        frame = std::move(free_.back());
        free_.pop_back();
      }
    }
    if (!frame) frame = std::make_unique<RecordedFrame>();
    return {frame.release(), [pool = weak_from_this()](RecordedFrame* dropped) {
              std::unique_ptr<RecordedFrame> owned(dropped);
              if (const auto alive = pool.lock()) alive->Give(std::move(owned));
            }};
  }

 private:
  // A loop that drops a frame after it has made the next one alternates between two.
  static constexpr std::size_t kMostFree = 2;

  void Give(std::unique_ptr<RecordedFrame> frame) {
    const std::lock_guard lock(mutex_);
    if (free_.size() < kMostFree) free_.push_back(std::move(frame));
  }

  std::mutex mutex_;
  std::vector<std::unique_ptr<RecordedFrame>> free_;
};

/// Thrown when the host program wants work in progress to end (HeldSimulation).
struct Interrupted {};

/// The simulation behind `railcast.Simulator`: the sensors of a scenario with the commands that
/// have been given to them. Thread-safe: calls wait for each other.
class HeldSimulation {
 public:
  /// Index or name of a sensor.
  using Sensor = std::variant<std::int64_t, std::string>;

  /// @param num_threads 0 = all cores.
  /// @param is_interrupted Called again and again while something takes long, by the thread that
  ///   waits for it. If it returns true, that work ends with Interrupted.
  /// @throws InputError with the faults of the scenario or "threads: must be >= 0 and <= 1024 (got
  ///   -1)".
  HeldSimulation(const ScenarioSpec& scenario,
                 std::int64_t num_threads,
                 std::function<bool()> is_interrupted);

  /// Makes a frame with all of its fields.
  /// @param has_objects Whether to describe the objects within range, which takes rays of its own.
  /// @throws InputError "frame: must be ..." or "sensor: must be ...", or if something leaves its
  ///   track in that frame.
  [[nodiscard]] std::shared_ptr<RecordedFrame> Scan(std::int64_t frame,
                                                    const Sensor& sensor,
                                                    bool has_objects);

  /// Applies a command, as a line of docs/commands.md, at the stamp of a sensor's frame.
  /// @throws InputError with the lines with which a live run answers it.
  void Apply(const std::string& line, std::int64_t frame, const Sensor& sensor);

  /// Returns the rails about the vehicle at a frame's stamp, in the axes of that sensor.
  /// @throws InputError as Scan() does, or "ahead_m: must be finite and >= 0 (got nan)".
  [[nodiscard]] std::vector<RailLines> Rails(std::int64_t frame,
                                             const Sensor& sensor,
                                             const RailReach& reach);

  /// Returns the samples of the motion sensors in the time of a frame of the first sensor.
  /// @throws InputError as Scan() does.
  [[nodiscard]] MotionSamples Motion(std::int64_t frame);

  /// False in a process that was forked after the simulation was made, where its threads are
  /// missing: the above throw InputError there, and the destructor would wait for them forever.
  [[nodiscard]] bool IsOfThisProcess() const;

  [[nodiscard]] const ScenarioSpec& scenario() const { return maker_.scenario(); }
  [[nodiscard]] const LabelTable& labels() const { return maker_.labels(); }

 private:
  [[nodiscard]] std::unique_lock<std::mutex> LockHere();
  [[nodiscard]] std::size_t IndexOf(const Sensor& sensor) const;
  [[nodiscard]] std::uint32_t FrameOf(std::int64_t frame, std::size_t sensor) const;
  /// Does work that may build a window, which the host program may interrupt.
  template <typename Work>
  void DoInterruptibly(const Work& work);
  void WatchForInterruption();
  void ChooseEffects();
  void Make(std::uint32_t frame, std::size_t sensor, bool has_objects, RecordedFrame& made);

  const pid_t made_in_;
  std::mutex mutex_;
  std::function<bool()> is_interrupted_;
  std::atomic<bool> was_interrupted_ = false;
  std::atomic<std::thread::id> waiting_;
  FrameMaker maker_;
  std::vector<std::shared_ptr<FramePool>> pools_;  // By sensor.
};

}  // namespace railcast
