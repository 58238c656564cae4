#include "generator/replay/step_loop.h"

#include <utility>
#include <variant>

namespace railcast {

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

}  // namespace railcast
