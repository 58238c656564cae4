#include "generator/extras/replay/replay_run.h"

#include <chrono>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/base/error.h"

namespace railcast {
namespace {

// A frame that is sent in a burst counts as late where it is not gone so long after it began.
constexpr std::int64_t kBurst_ns = 50'000'000;

}  // namespace

NextFrames StepLoop::AwaitStep(const std::function<bool()>& is_stopped) {
  // The longest time until a waiting replay notices that it was stopped.
  constexpr int kStopWait_ms = 50;
  while (!is_stopped()) {
    auto request = source_.Next(kStopWait_ms);
    if (!request) continue;
    if (std::holds_alternative<Step>(request->command)) {
      step_ = std::move(request);
      return NextFrames::kMake;
    }
    source_.Refuse(*request, {"command: must be step, since a replay is as it was recorded (got " +
                              CommandName(request->command) + ")"});
  }
  return NextFrames::kStop;
}

void StepLoop::EndStep(std::int64_t time_ns) {
  if (step_) source_.Acknowledge(*step_, time_ns);
  step_.reset();
}

void StepLoop::End(const std::string& reason) {
  auto request = std::exchange(step_, std::nullopt);
  if (!request) request = source_.Next(0);
  for (; request; request = source_.Next(0)) source_.Refuse(*request, {reason});
}

LiveResult RunReplay(ReplayFeed& feed, const ReplayRunSpec& spec, LiveClock& clock) {
  bool is_over = !feed.Load();
  std::optional<std::string> fault;
  const auto make = [&](std::uint32_t, Datagrams& datagrams) {
    feed.Take(datagrams);
    try {
      is_over = !feed.Load();
    } catch (const InputError& error) {
      // What was read before is sent.
      is_over = true;
      fault = error.what();
    }
  };
  const std::vector<LiveSensor> sensors = {
      {.name = feed.name(),
       .period_ns = kBurst_ns,
       .latency_ns = spec.pacing == Pacing::kBurst ? kBurst_ns : 0,
       .stamp_ns = [&](std::uint32_t) { return feed.begin_ns(); },
       .make = make,
       .send = [&](const Datagrams& datagrams,
                   std::span<const Datagrams::Item> items) { feed.Send(datagrams, items); },
       .sends = feed.sends()}};
  const auto is_stopped = [&] { return is_over || spec.is_stopped(); };
  LiveHooks hooks;
  hooks.is_stopped = is_stopped;
  if (spec.steps != nullptr) {
    hooks.begin_frames = [&](std::int64_t) { return spec.steps->AwaitStep(is_stopped); };
  }
  hooks.end_frames = [&](const RunState& state) {
    if (spec.steps != nullptr) spec.steps->EndStep(state.stamp_ns);
    spec.show(state);
  };
  const LiveRunSpec run = {.pacing = spec.pacing,
                           .lockstep = spec.steps != nullptr,
                           .lead_ns = spec.steps != nullptr ? 0 : ReplayRunSpec::kLead_ns,
                           .duration_ns = {}};
  if (spec.states_utc) {
    const std::chrono::nanoseconds now = std::chrono::system_clock::now().time_since_epoch();
    feed.SetClock(now.count() + run.lead_ns);
  }
  LiveResult result = RunLive(run, sensors, hooks, clock);
  if (!result.fault) result.fault = fault;
  return result;
}

}  // namespace railcast
