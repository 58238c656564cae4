#include "generator/live/run_surroundings.h"

#include <systemd/sd-daemon.h>
#include <algorithm>
#include <chrono>

#include "core/program/stop_signals.h"
#include "generator/live/live_clock.h"

namespace railcast {

ServiceManager::ServiceManager() : pause_ns_(5'000'000'000) {
  std::uint64_t watchdog_us = 0;
  if (::sd_watchdog_enabled(0, &watchdog_us) <= 0) return;
  // sd_watchdog_enabled(3) recommends half of it; a third survives a slow frame.
  pause_ns_ = std::min(pause_ns_, static_cast<std::int64_t>(watchdog_us) * 1000 / 3);
}

void ServiceManager::SayReady() {
  ::sd_notify(0, ("READY=1\nSTATUS=" + status_).c_str());
}

void ServiceManager::SayAlive() {
  const std::int64_t now_ns = MonotonicClock().NowNs();
  if (now_ns - said_ns_ < pause_ns_) return;
  said_ns_ = now_ns;
  ::sd_notify(0, ("WATCHDOG=1\nSTATUS=" + status_).c_str());
}

void ServiceManager::SayStopping() {
  ::sd_notify(0, "STOPPING=1");
}

std::int64_t UtcNow_ns() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::nanoseconds>(now).count();
}

void SetClocks(LiveStreams& streams, const StreamOptions& options, std::int64_t lead_ns) {
  if (StatesTimeOfDay(options)) streams.SetClocks(UtcNow_ns(), lead_ns);
}

RunSurroundings::RunSurroundings(LiveStreams& streams,
                                 CommandLoop* commands,
                                 const StreamOptions& options,
                                 LiveHealth& health)
    : streams_(streams),
      commands_(commands),
      options_(options),
      health_(health),
      is_offline_(IsOffline(options)),
      lag_(options.drops_late) {}

LiveHooks RunSurroundings::Hooks() {
  return {.is_stopped = [this] { return IsStopped(); },
          .begin_frames = [this](std::int64_t stamp_ns) { return BeginFrames(stamp_ns); },
          .end_frames = [this](const RunState& state) { EndFrames(state); }};
}

void RunSurroundings::Begin() {
  health_.Begin();
  manager_.SayReady();
}

void RunSurroundings::End() {
  health_.End();
  manager_.SayStopping();
  SayCaptureFaults();
  line_.End();
}

// A run without receivers serves only its capture, so it ends when the capture fails.
bool RunSurroundings::IsStopped() {
  // Asked while the run waits, too: it goes on.
  health_.Beat();
  manager_.SayAlive();
  return StopRequested() || (is_offline_ && !streams_.CaptureFaults().empty());
}

NextFrames RunSurroundings::BeginFrames(std::int64_t stamp_ns) {
  if (commands_ == nullptr) return NextFrames::kMake;
  const NextFrames next = commands_->BeginFrames(stamp_ns, [this] { return IsStopped(); });
  if (next != NextFrames::kReset) return next;
  streams_.Restart();
  // Where commands are heard, no frame is begun before its stamp.
  SetClocks(streams_, options_, 0);
  return next;
}

void RunSurroundings::EndFrames(const RunState& state) {
  if (commands_ != nullptr) commands_->EndFrames(state.stamp_ns);
  SayCaptureFaults();
  if (const auto lag = lag_.After(state)) line_.Say(*lag);
  const std::string progress = LiveProgress(state);
  line_.Show(progress);
  health_.Update(state);
  manager_.SetStatus(progress);
  manager_.SayAlive();
}

void RunSurroundings::SayCaptureFaults() {
  const std::vector<std::string> faults = streams_.CaptureFaults();
  for (; num_faults_said_ < faults.size(); ++num_faults_said_) {
    line_.Say(faults[num_faults_said_]);
  }
}

}  // namespace railcast
