#include "generator/live/command_loop.h"

#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/scenario/command_log.h"

namespace railcast {
namespace {

// The longest time until a waiting run notices that it was stopped.
constexpr int kPatience_ms = 50;

}  // namespace

CommandLoop::CommandLoop(FrameMaker& maker,
                         CommandChannel& channel,
                         bool lockstep,
                         const std::optional<std::filesystem::path>& log_file,
                         const std::string& scenario_xxh3)
    : maker_(maker), channel_(channel), lockstep_(lockstep) {
  if (!log_file) return;
  if (std::filesystem::exists(*log_file)) {
    throw InputError("--commands-log: must not exist yet (got " + ShownPath(*log_file) + ")");
  }
  log_.emplace(*log_file, 0);
  log_->Append(CommandLogHeader(scenario_xxh3));
}

NextFrames CommandLoop::BeginFrames(std::int64_t stamp_ns,
                                    const std::function<bool()>& is_stopped) {
  for (int i = 0; lockstep_ || i < kMaxPerFrame; ++i) {
    if (is_stopped()) return NextFrames::kStop;
    const auto request = channel_.Next(lockstep_ ? kPatience_ms : 0);
    if (!request && !lockstep_) break;
    if (!request) continue;
    if (lockstep_ && std::holds_alternative<Step>(request->command)) {
      step_ = request;
      break;
    }
    if (Handle(*request, stamp_ns)) return NextFrames::kReset;
  }
  return NextFrames::kMake;
}

void CommandLoop::End(const std::string& reason) {
  std::optional<CommandRequest> waiting = std::move(step_);
  step_.reset();
  if (!waiting) waiting = channel_.Next(0);
  for (; waiting; waiting = channel_.Next(0)) channel_.Refuse(*waiting, {reason});
}

bool CommandLoop::Handle(const CommandRequest& request, std::int64_t stamp_ns) {
  if (std::holds_alternative<Step>(request.command)) {
    channel_.Refuse(request, {"command: step needs --lockstep; this run does not wait for steps"});
    return false;
  }
  const bool is_reset = std::holds_alternative<Reset>(request.command);
  const std::int64_t time_ns = is_reset ? 0 : stamp_ns;
  try {
    maker_.Apply(request.command, time_ns);
  } catch (const InputError& error) {
    channel_.Refuse(request, {error.what()});
    return false;
  }
  if (log_) log_->Append(CommandLogLine({time_ns, request.command}));
  channel_.Acknowledge(request, time_ns);
  return is_reset;
}

void CommandLoop::EndFrames(std::int64_t stamp_ns) {
  maker_.ForgetBefore(stamp_ns);
  if (!step_) return;
  channel_.Acknowledge(*step_, stamp_ns);
  step_.reset();
}

}  // namespace railcast
