#include "generator/live/live_control.h"

#include <systemd/sd-daemon.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <string_view>
#include <utility>

#include "core/program/stop_signals.h"
#include "core/program/version.h"
#include "generator/live/live_clock.h"

namespace railcast {
namespace {

double Seconds(std::int64_t time_ns) {
  return static_cast<double>(time_ns) / 1e9;
}

/// Escapes a value of a label as Prometheus' text format wants it.
std::string LabelValue(std::string_view text) {
  std::string value;
  for (const char c : text) {
    if (c == '\n') {
      value += "\\n";
      continue;
    }
    if (c == '\\' || c == '"') value += '\\';
    value += c;
  }
  return value;
}

std::string Number(double value) {
  return nlohmann::json(value).dump();
}

void AddMetric(std::string& text,
               std::string_view name,
               std::string_view type,
               std::string_view help) {
  text.append("# HELP ").append(name).append(" ").append(help).append("\n# TYPE ");
  text.append(name).append(" ").append(type).append("\n");
}

}  // namespace

LiveHealth::LiveHealth(Now now_ns) : now_ns_(std::move(now_ns)), heard_ns_(now_ns_()) {}

void LiveHealth::Begin() {
  const std::lock_guard lock(mutex_);
  phase_ = Phase::kRunning;
  heard_ns_ = now_ns_();
}

void LiveHealth::Beat() {
  const std::lock_guard lock(mutex_);
  heard_ns_ = now_ns_();
}

void LiveHealth::Update(const RunState& state) {
  const std::lock_guard lock(mutex_);
  heard_ns_ = now_ns_();
  stamp_ns_ = state.stamp_ns;
  behind_ns_ = state.behind_ns;
  sensors_.resize(state.records.size());
  for (std::size_t i = 0; i < sensors_.size(); ++i) {
    const LiveRecord& record = state.records[i];
    sensors_[i] = {.name = record.name,
                   .frames = record.frames,
                   .late_frames = record.late_frames,
                   .dropped_frames = record.dropped_frames,
                   .compute_ns = record.compute.total_ns(),
                   .max_compute_ns = record.compute.max_ns(),
                   .uncertified_frames = record.uncertified_frames};
  }
}

void LiveHealth::End() {
  const std::lock_guard lock(mutex_);
  phase_ = Phase::kEnding;
}

std::string LiveHealth::Status() const {
  if (phase_ == Phase::kStarting) return "starting";
  if (phase_ == Phase::kEnding) return "ending";
  return now_ns_() - heard_ns_ > kStalled_ns ? "stalled" : "running";
}

std::string LiveHealth::Line() const {
  SensorCounts all;
  for (const SensorCounts& sensor : sensors_) {
    all.frames += sensor.frames;
    all.late_frames += sensor.late_frames;
    all.dropped_frames += sensor.dropped_frames;
    if (!sensor.uncertified_frames) continue;
    all.uncertified_frames = all.uncertified_frames.value_or(0) + *sensor.uncertified_frames;
  }
  nlohmann::ordered_json line = {{"status", Status()},
                                 {"frames", all.frames},
                                 {"late_frames", all.late_frames},
                                 {"dropped_frames", all.dropped_frames},
                                 {"behind_s", Seconds(behind_ns_)}};
  if (all.uncertified_frames) line["uncertified_frames"] = *all.uncertified_frames;
  return line.dump() + "\n";
}

std::string LiveHealth::Metrics() const {
  std::string text;
  AddMetric(text, "railcast_info", "gauge", "The program's version.");
  text += "railcast_info{version=\"" + LabelValue(ProgramVersion()) + "\"} 1\n";
  AddMetric(text, "railcast_running", "gauge", "1 while frames are made.");
  text += std::string("railcast_running ") + (Status() == "running" ? "1" : "0") + "\n";
  AddMetric(text, "railcast_simulated_seconds", "gauge", "Simulation time of the last frame.");
  text += "railcast_simulated_seconds " + Number(Seconds(stamp_ns_)) + "\n";
  AddMetric(text, "railcast_behind_seconds", "gauge", "Delay with which frames begin.");
  text += "railcast_behind_seconds " + Number(Seconds(behind_ns_)) + "\n";
  const auto add = [&](std::string_view name, std::string_view type, std::string_view help,
                       const auto& value_of) {
    AddMetric(text, name, type, help);
    for (const SensorCounts& sensor : sensors_) {
      text.append(name).append("{sensor=\"").append(LabelValue(sensor.name)).append("\"} ");
      text.append(value_of(sensor)).append("\n");
    }
  };
  add("railcast_frames_total", "counter", "Frames that were made.",
      [](const SensorCounts& counts) { return std::to_string(counts.frames); });
  add("railcast_late_frames_total", "counter", "Frames that were not made in time.",
      [](const SensorCounts& counts) { return std::to_string(counts.late_frames); });
  add("railcast_dropped_frames_total", "counter",
      "Frames that were left out because they were late.",
      [](const SensorCounts& counts) { return std::to_string(counts.dropped_frames); });
  add("railcast_compute_seconds_total", "counter", "Time in which frames were made.",
      [](const SensorCounts& counts) { return Number(Seconds(counts.compute_ns)); });
  add("railcast_compute_seconds_max", "gauge", "Longest time in which a frame was made.",
      [](const SensorCounts& counts) { return Number(Seconds(counts.max_compute_ns)); });
  if (sensors_.empty() || !sensors_.front().uncertified_frames) return text;
  add("railcast_uncertified_frames_total", "counter",
      "Frames for whose certificates there was no time.", [](const SensorCounts& counts) {
        return std::to_string(counts.uncertified_frames.value_or(0));
      });
  return text;
}

HttpAnswer LiveHealth::Answer(const HttpRequest& request) const {
  const std::lock_guard lock(mutex_);
  const std::string_view path =
      std::string_view(request.target).substr(0, request.target.find('?'));
  const bool is_read = request.method == "GET" || request.method == "HEAD";
  if (path == "/health" && is_read) {
    return {.status = Status() == "running" ? 200U : 503U, .body = Line()};
  }
  if (path == "/metrics" && is_read) {
    return {.body = Metrics(), .content_type = "text/plain; version=0.0.4; charset=utf-8"};
  }
  constexpr unsigned kNotFound = 404, kNotAllowed = 405;
  const bool is_known = path == "/health" || path == "/metrics";
  return {.status = is_known ? kNotAllowed : kNotFound,
          .body = is_known ? "{\"error\":\"only GET is answered\"}\n"
                           : "{\"error\":\"there are /health and /metrics\"}\n"};
}

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

LiveControl::LiveControl(LiveStreams& streams,
                         CommandLoop* commands,
                         const StreamOptions& options,
                         LiveHealth& health)
    : streams_(streams),
      commands_(commands),
      options_(options),
      health_(health),
      is_offline_(IsOffline(options)),
      lag_(options.drops_late) {}

LiveHooks LiveControl::Hooks() {
  return {.is_stopped = [this] { return IsStopped(); },
          .begin_frames = [this](std::int64_t stamp_ns) { return BeginFrames(stamp_ns); },
          .end_frames = [this](const RunState& state) { EndFrames(state); }};
}

void LiveControl::Begin() {
  health_.Begin();
  manager_.SayReady();
}

void LiveControl::End() {
  health_.End();
  manager_.SayStopping();
  SayCaptureFaults();
  line_.End();
}

// A run without receivers serves only its capture, so it ends when the capture fails.
bool LiveControl::IsStopped() {
  // Asked while the run waits, too: it goes on.
  health_.Beat();
  manager_.SayAlive();
  return StopRequested() || (is_offline_ && !streams_.CaptureFaults().empty());
}

NextFrames LiveControl::BeginFrames(std::int64_t stamp_ns) {
  if (commands_ == nullptr) return NextFrames::kMake;
  const NextFrames next = commands_->BeginFrames(stamp_ns, [this] { return IsStopped(); });
  if (next != NextFrames::kReset) return next;
  streams_.Restart();
  // Where commands are heard, no frame is begun before its stamp.
  SetClocks(streams_, options_, 0);
  return next;
}

void LiveControl::EndFrames(const RunState& state) {
  if (commands_ != nullptr) commands_->EndFrames(state.stamp_ns);
  SayCaptureFaults();
  if (const auto lag = lag_.After(state)) line_.Say(*lag);
  const std::string progress = LiveProgress(state);
  line_.Show(progress);
  health_.Update(state);
  manager_.SetStatus(progress);
  manager_.SayAlive();
}

void LiveControl::SayCaptureFaults() {
  const std::vector<std::string> faults = streams_.CaptureFaults();
  for (; num_faults_said_ < faults.size(); ++num_faults_said_) {
    line_.Say(faults[num_faults_said_]);
  }
}

}  // namespace railcast
