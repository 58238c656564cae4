#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/io/datagrams.h"
#include "generator/live/datagram_queue.h"
#include "generator/live/duration_histogram.h"
#include "generator/live/live_clock.h"

namespace railcast {

/// A sensor whose frames are made and sent.
struct LiveSensor {
  std::string name;
  std::int64_t period_ns{};
  /// Simulation time at which a frame begins.
  std::function<std::int64_t(std::uint32_t frame)> stamp_ns;
  /// Scans a frame and appends its datagrams. Frames come in order. Throws RunStopped where the run
  /// was stopped before the frame was made.
  std::function<void(std::uint32_t frame, Datagrams& datagrams)> make;
  /// Called from another thread than `make`, while that makes the next frame.
  DatagramQueue::Send send;
};

enum class Pacing {
  kSpread,  ///< Each datagram one period after its last firing: frame n + 1 is made meanwhile.
  kBurst,   ///< A frame's datagrams at once, as soon as it is made.
};

/// What became of one sensor's frames.
struct LiveRecord {
  std::string name{};
  std::int64_t period_ns{};
  std::uint64_t frames{};
  /// Not made, in bursts also sent, when their own period ended. None in lockstep.
  std::uint64_t late_frames{};
  std::uint64_t dropped_frames{};  ///< Not made, since they would have been late.
  DurationHistogram compute{};     ///< Scanning and encoding, by frame.
  SentRecord sent{};
};

/// How far a run is after the frames of one stamp.
struct RunState {
  std::int64_t stamp_ns{};
  std::int64_t now_ns{};     ///< Of the run's clock.
  std::int64_t behind_ns{};  ///< By how much the next frames begin too late; 0 in lockstep.
  /// By sensor; not final, since what was sent is not in them.
  const std::vector<LiveRecord>& records;
};

enum class NextFrames {
  kMake,
  kReset,  ///< The run begins anew with all sensors' frame 0.
  kStop,
};

/// What a run asks of its surroundings, always from its own thread.
struct LiveHooks {
  std::function<bool()> is_stopped = [] { return false; };
  /// Before frames that begin at this simulation time are made: commands take effect here. In
  /// lockstep it waits until they are asked for.
  std::function<NextFrames(std::int64_t stamp_ns)> begin_frames = [](std::int64_t) {
    return NextFrames::kMake;
  };
  /// After they were made, and in lockstep also sent.
  std::function<void(const RunState&)> end_frames = [](const RunState&) {};
};

struct LiveRunSpec {
  Pacing pacing = Pacing::kSpread;
  bool lockstep = false;    ///< Frames are made when begin_frames says so, not at their time.
  bool drops_late = false;  ///< Frames that cannot be in time are not made. Not in lockstep.
  std::optional<std::int64_t> duration_ns;  ///< Of simulation time; absent = until stopped.
};

struct LiveResult {
  std::vector<LiveRecord> records;   ///< By sensor.
  std::optional<std::string> fault;  ///< Why the next frame could not be made, if that ended it.
};

/// Makes and sends frames at their rate until the duration is over, the run is stopped or a
/// frame cannot be made (InputError). What was made is sent in any case.
///
/// Frame n of a sensor begins at simulation time stamp_ns(n) and is made in the period that begins
/// at the same time of the clock, counted from the run's start: deadlines are absolute, so nothing
/// adds up. A frame that is late is made and sent all the same, whole; the following ones go on as
/// fast as they can until they have caught up. Or, with drops_late, a frame whose period has ended
/// before it is begun is left out, all of it; the others are what they always are. A sensor's frame
/// 0 is always made.
[[nodiscard]] LiveResult RunLive(const LiveRunSpec& spec,
                                 const std::vector<LiveSensor>& sensors,
                                 const LiveHooks& hooks,
                                 LiveClock& clock);

}  // namespace railcast
