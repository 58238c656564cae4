#include "viewer/pick/effect_trace.h"

#include <chrono>
#include <system_error>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/simulate/story_text.h"
#include "railcast/effects.h"
#include "railcast/fidelity.h"
#include "railcast/frame.h"
#include "railcast/lidar.h"
#include "railcast/material.h"
#include "railcast/scenario.h"

namespace railcast {

namespace {

/// Thrown to give up a trace that is no longer wanted.
struct Ended {};

void CheckIsTraceable(const std::filesystem::path& source,
                      const std::optional<ScenarioSpec>& scenario) {
  if (!scenario) throw InputError(ShownPath(source) + ": has no scenario to trace points with");
  const std::filesystem::path commands = source / "commands.jsonl";
  std::error_code ignored;  // A source that is no directory holds no file.
  if (std::filesystem::exists(commands, ignored)) {
    throw InputError(ShownPath(commands) +
                     ": changed the run, so the scenario alone cannot repeat it");
  }
}

void CheckIsOfPattern(const RecordedFrame& recorded, const ScanPattern& pattern) {
  const Frame& frame = recorded.frame;
  if (!recorded.is_grid) {
    throw InputError(
        recorded.name +
        ": is no grid of firings, so the firing of a point is not known (a stream needs "
        "the fields ring and column)");
  }
  if (frame.rows == pattern.rows && frame.columns == pattern.columns) return;
  throw InputError(recorded.name + ": must have the firings of its scenario, " +
                   std::to_string(pattern.rows) + " x " + std::to_string(pattern.columns) +
                   " (got " + std::to_string(frame.rows) + " x " + std::to_string(frame.columns) +
                   ")");
}

}  // namespace

void Tracing::Ask(std::size_t source,
                  const RecordingInfo& info,
                  std::shared_ptr<const RecordedFrame> recorded,
                  std::uint32_t slot) {
  auto& trace = traces_[source];
  if (!trace) trace = std::make_unique<EffectTrace>(info);
  (void)trace->Take();  // Discard the answer to an earlier question.
  trace->Ask(std::move(recorded), slot);
  asked_ = source;
}

std::optional<std::string> Tracing::Take() {
  if (!asked_) return std::nullopt;
  auto answer = traces_[*asked_]->Take();
  if (answer) asked_.reset();
  return answer;
}

EffectTrace::EffectTrace(const RecordingInfo& info)
    : source_(info.source), scenario_(info.scenario) {}

EffectTrace::~EffectTrace() {
  is_ending_ = true;
}

std::unique_ptr<Simulator> EffectTrace::BuildSimulator() const {
  auto simulator = MakeSimulator(*scenario_, 0);
  if (scenario_->fidelity == Fidelity::kAuto) {
    UseChosenFidelity(*simulator, *scenario_, [this](double) {
      if (is_ending_) throw Ended{};
    });
  }
  return simulator;
}

std::string EffectTrace::Answer(const RecordedFrame& recorded, std::uint32_t slot) {
  try {
    CheckIsTraceable(source_, scenario_);
    if (!simulator_) simulator_ = BuildSimulator();
    CheckIsOfPattern(recorded, simulator_->pattern());
    // A recorded frame may have fewer slots per firing than the sensor if none of its points is a
    // second or later return.
    const Frame& frame = recorded.frame;
    const std::uint32_t firing = FiringOfSlot(simulator_->pattern(), frame.returns, slot);
    return StoryText(frame.index, simulator_->Explain(frame.index, firing),
                     LabelTable(scenario_->labels), MaterialLibrary(scenario_->materials));
  } catch (const InputError& error) {
    return std::string("error: ").append(error.what());
  }
}

std::string EffectTrace::Of(const RecordedFrame& recorded, std::uint32_t slot) {
  // The simulator serves one request at a time.
  if (under_way_.valid()) under_way_.wait();
  return Answer(recorded, slot);
}

void EffectTrace::Begin(Question question) {
  under_way_ = std::async(std::launch::async, [this, question = std::move(question)] {
    return Answer(*question.recorded, question.slot);
  });
}

void EffectTrace::Ask(std::shared_ptr<const RecordedFrame> recorded, std::uint32_t slot) {
  pending_ = Question{std::move(recorded), slot};
  if (under_way_.valid()) return;
  Begin(*std::exchange(pending_, std::nullopt));
}

std::optional<std::string> EffectTrace::Take() {
  const bool is_there = under_way_.valid() &&
                        under_way_.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
  if (!is_there) return std::nullopt;
  std::string answer = under_way_.get();
  if (!pending_) return answer;
  Begin(*std::exchange(pending_, std::nullopt));
  return std::nullopt;
}

}  // namespace railcast
