#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/certify/certified_figures.h"
#include "core/io/datagrams.h"
#include "core/program/duration_histogram.h"
#include "generator/live/datagram_queue.h"
#include "generator/live/live_clock.h"
#include "railcast/frame.h"

namespace railcast {

/// A sensor whose frames are made and sent.
struct LiveSensor {
  std::string name;
  std::int64_t period_ns{};
  /// How long after its time a datagram leaves with Pacing::kSpread; at most a period.
  std::int64_t latency_ns = period_ns;
  /// Returns the simulation time at which a frame begins.
  std::function<std::int64_t(std::uint32_t frame)> stamp_ns;
  /// Scans a frame and appends its datagrams. Frames come in order. Throws RunStopped if the run
  /// was stopped before the frame was complete.
  std::function<void(std::uint32_t frame, Datagrams& datagrams)> make;
  /// Called from another thread than `make`, possibly while `make` is working on the next frame.
  DatagramQueue::Send send;
  std::string_view sends = "datagrams";  ///< What it sends, as the summary calls it.
  const Frame* frame = nullptr;          ///< The one that was made last; null = unknown.
  /// Certifies that frame; empty = frames are not certified.
  std::function<void()> certify{};
  std::int64_t certify_ns{};  ///< What that took before the run.
};

enum class Pacing {
  /// Each datagram one period (LiveSensor::latency_ns) after its last firing, while frame n + 1 is
  /// being made.
  kSpread,
  kBurst,  ///< All datagrams of a frame at once, as soon as it has begun and is made.
};

/// Statistics of one sensor's frames.
struct LiveRecord {
  std::string name{};
  std::int64_t period_ns{};
  std::uint64_t frames{};
  /// Frames that were not made (in bursts: not made and sent) by the end of their own period. 0 in
  /// lockstep.
  std::uint64_t late_frames{};
  std::uint64_t dropped_frames{};  ///< Left out because they would have been late.
  DurationHistogram compute{};     ///< Time for scanning and encoding, by frame.
  SentRecord sent{};
  std::string_view sends = "datagrams";  ///< LiveSensor::sends.
  /// Frames for whose certificates there was no time; absent where frames are not certified.
  std::optional<std::uint64_t> uncertified_frames{};
  DurationHistogram certify{};  ///< Time for a certificate, by frame.
  std::optional<RunCertificate>
      certificate{};  ///< For all frames since the last reset; not set here.
};

/// The progress of a run after the frames of one stamp.
struct RunState {
  std::int64_t stamp_ns{};
  std::int64_t now_ns{};     ///< By the run's clock.
  std::int64_t behind_ns{};  ///< Delay with which the next frames begin; 0 in lockstep.
  /// By sensor. Not final: statistics of sending are not included yet.
  const std::vector<LiveRecord>& records;
};

enum class NextFrames {
  kMake,
  kReset,  ///< The run begins anew with frame 0 of all sensors.
  kStop,
};

/// Callbacks of a run, always called from its own thread.
struct LiveHooks {
  std::function<bool()> is_stopped = [] { return false; };
  /// Called before the frames that begin at this simulation time are made; commands take effect
  /// here. In lockstep it waits until frames are asked for.
  std::function<NextFrames(std::int64_t stamp_ns)> begin_frames = [](std::int64_t) {
    return NextFrames::kMake;
  };
  /// Called after the frames were made and, in lockstep, also sent.
  std::function<void(const RunState&)> end_frames = [](const RunState&) {};
};

struct LiveRunSpec {
  Pacing pacing = Pacing::kSpread;
  bool lockstep = false;    ///< Frames are made when begin_frames returns, not at their time.
  bool drops_late = false;  ///< Leave out frames that would be late. Not in lockstep.
  /// How long before its stamp a frame may be begun, at most a period, so that a frame that takes
  /// longer than others uses what they left. Not in lockstep, and not with commands: they hold for
  /// frames that are not begun.
  std::int64_t lead_ns = 0;
  std::optional<std::int64_t> duration_ns;  ///< Simulation time; absent = until stopped.
};

struct LiveResult {
  std::vector<LiveRecord> records;  ///< By sensor.
  /// Why the next frame could not be made, if that ended the run.
  std::optional<std::string> fault;
  std::optional<std::string> log_fault{};  ///< CommandLoop::log_fault(); not set here.
};

/// Makes and sends frames at their rate until the duration is over, the run is stopped or a frame
/// cannot be made (InputError). Frames that were made are sent in any case.
///
/// Frame n of a sensor begins at simulation time stamp_ns(n) and is made in the period that begins
/// at the same time of the clock, counted from the run's start, or before. Deadlines are absolute,
/// so delays do not accumulate. A late frame is still made and sent in full, and the following
/// frames are made as fast as possible until the run has caught up. With drops_late, instead, a
/// frame whose period has ended before work on it begins is left out entirely; the other frames are
/// unaffected. A sensor's frame 0 is always made.
///
/// Frames are certified once all of their stamp are made (in lockstep, sent), if that will be done
/// before the next ones begin. In lockstep and by a clock that jumps there is always time.
[[nodiscard]] LiveResult RunLive(const LiveRunSpec& spec,
                                 const std::vector<LiveSensor>& sensors,
                                 const LiveHooks& hooks,
                                 LiveClock& clock);

}  // namespace railcast
