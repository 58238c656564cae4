#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/io/net/http_server.h"
#include "core/program/progress_line.h"
#include "generator/live/command_channel.h"
#include "generator/live/live_clock.h"
#include "generator/live/live_options.h"
#include "generator/live/live_run.h"
#include "generator/live/live_streams.h"
#include "generator/live/live_summary.h"

namespace railcast {

/// How a live run is doing, for those who watch over it by HTTP. The run tells it from its thread;
/// any thread may ask.
///
/// `GET /health` gives one line of JSON, with status 200 while the run goes on and 503 otherwise:
///
///     {"status":"running","frames":120,"late_frames":0,"dropped_frames":0,"behind_s":0.0}
///
/// `GET /metrics` gives counters in the text format of Prometheus (version 0.0.4).
class LiveHealth {
 public:
  /// A run that has not been heard of for so long has stalled.
  static constexpr std::int64_t kStalled_ns = 10'000'000'000;
  using Now = std::function<std::int64_t()>;

  /// @param now_ns A clock that never goes back.
  explicit LiveHealth(Now now_ns = [] { return MonotonicClock().NowNs(); });

  /// Frames are made from now on.
  void Begin();
  /// The run goes on, perhaps waiting for commands.
  void Beat();
  void Update(const RunState& state);
  void End();

  [[nodiscard]] HttpAnswer Answer(const HttpRequest& request) const;

 private:
  enum class Phase { kStarting, kRunning, kEnding };
  struct SensorCounts {
    std::string name;
    std::uint64_t frames{}, late_frames{}, dropped_frames{};
    std::int64_t compute_ns{}, max_compute_ns{};
    std::optional<std::uint64_t> uncertified_frames;
  };

  [[nodiscard]] std::string Status() const;
  [[nodiscard]] std::string Line() const;
  [[nodiscard]] std::string Metrics() const;

  Now now_ns_;
  mutable std::mutex mutex_;
  Phase phase_ = Phase::kStarting;
  std::int64_t heard_ns_{};
  std::int64_t stamp_ns_{}, behind_ns_{};
  std::vector<SensorCounts> sensors_;
};

/// Tells systemd that the program is ready and goes on (sd_notify, Type=notify and WatchdogSec= of
/// a unit). Does nothing where no manager has started the program.
class ServiceManager {
 public:
  ServiceManager();

  void SayReady();
  /// Sets the line that `systemctl status` shows from the next SayAlive() on that is passed on.
  void SetStatus(std::string status) { status_ = std::move(status); }
  /// To be called often; the manager hears of it as often as its watchdog wants.
  void SayAlive();
  void SayStopping();

 private:
  std::int64_t pause_ns_;
  std::int64_t said_ns_{};
  std::string status_ = "making frames";
};

/// The time since 1970.
[[nodiscard]] std::int64_t UtcNow_ns();

/// Lets stamps state the time of day from now on, if asked to.
void SetClocks(LiveStreams& streams, const StreamOptions& options, std::int64_t lead_ns);

/// Connects a run with its commands, the user and those who watch over it, and shows its progress.
class LiveControl {
 public:
  /// @param commands Null where none are heard.
  LiveControl(LiveStreams& streams,
              CommandLoop* commands,
              const StreamOptions& options,
              LiveHealth& health);

  [[nodiscard]] LiveHooks Hooks();
  /// Says that the first frame can be made.
  void Begin();
  void End();

 private:
  [[nodiscard]] bool IsStopped();
  [[nodiscard]] NextFrames BeginFrames(std::int64_t stamp_ns);
  void EndFrames(const RunState& state);
  void SayCaptureFaults();

  LiveStreams& streams_;
  CommandLoop* commands_;
  const StreamOptions& options_;
  LiveHealth& health_;
  ServiceManager manager_;
  bool is_offline_;
  TerminalLine line_;
  LagReport lag_;
  std::size_t num_faults_said_ = 0;
};

}  // namespace railcast
