#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

#include "core/program/progress_line.h"
#include "generator/live/command_channel.h"
#include "generator/live/live_health.h"
#include "generator/live/live_run.h"
#include "generator/live/live_streams.h"
#include "generator/live/live_summary.h"
#include "generator/live/stream_options.h"

namespace railcast {

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
class RunSurroundings {
 public:
  /// @param commands Null where none are heard.
  RunSurroundings(LiveStreams& streams,
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
