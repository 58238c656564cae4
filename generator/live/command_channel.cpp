#include "generator/live/command_channel.h"

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string_view>
#include <utility>

#include "core/base/error.h"
#include "core/base/join.h"
#include "core/base/out_of_memory.h"
#include "core/base/text.h"
#include "core/io/write_file.h"
#include "core/scenario/command_log.h"

namespace railcast {
namespace {

using Json = nlohmann::ordered_json;

// Every answer begins so and no command does, so a line is recognised as an answer however long it
// is.
constexpr std::string_view kAnswerBegin = R"({"ok":)";

Json AnswerTo(const CommandTag& tag, bool is_done) {
  Json answer;
  answer["ok"] = is_done;
  if (tag.session) answer["session"] = *tag.session;
  if (tag.id) answer["id"] = *tag.id;
  return answer;
}

std::string LineOf(const Json& answer) {
  // A fault may quote text that is not valid UTF-8.
  std::string line = answer.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
  Check(line.starts_with(kAnswerBegin), "an answer is known by its begin");
  return line;
}

std::string FaultAnswer(const CommandTag& tag, const std::vector<std::string>& faults) {
  Json answer = AnswerTo(tag, false);
  answer["faults"] = faults;
  return LineOf(answer);
}

bool HasBoth(const CommandTag& tag) {
  return tag.session && tag.id;
}

/// Returns the lines that are not empty.
std::vector<std::string_view> LinesOf(std::string_view text) {
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    if (end > 0) lines.push_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

// The longest time until a waiting run notices that it was stopped.
constexpr int kPatience_ms = 50;

}  // namespace

CommandChannel::CommandChannel(const Endpoint& at,
                               const Endpoint& peer,
                               std::vector<ModelSpec> models)
    : receiver_(at),
      peer_(peer),
      models_(std::move(models)),
      thread_(StartThread("starting to hear commands", [this] { Listen(); })) {}

CommandChannel::~CommandChannel() {
  receiver_.Interrupt();
  thread_.join();
}

std::uint64_t CommandChannel::num_strangers() const {
  const std::lock_guard lock(mutex_);
  return num_strangers_;
}

std::uint64_t CommandChannel::num_answers() const {
  const std::lock_guard lock(mutex_);
  return num_answers_;
}

std::optional<CommandRequest> CommandChannel::Next(int timeout_ms) {
  std::unique_lock lock(mutex_);
  arrived_.wait_for(lock, std::chrono::milliseconds(timeout_ms),
                    [&] { return !requests_.empty(); });
  if (requests_.empty()) return std::nullopt;
  CommandRequest request = std::move(requests_.front());
  requests_.pop_front();
  return request;
}

void CommandChannel::Acknowledge(const CommandRequest& request, std::int64_t time_ns) {
  Json answer = AnswerTo(request.tag, true);
  answer["command"] = CommandName(request.command);
  answer["time_ns"] = time_ns;
  Send(request, LineOf(answer));
}

void CommandChannel::Refuse(const CommandRequest& request, const std::vector<std::string>& faults) {
  Send(request, FaultAnswer(request.tag, faults));
}

void CommandChannel::Listen() {
  while (true) {
    const auto received = receiver_.Receive(-1);
    if (receiver_.is_interrupted()) return;
    if (!received) continue;
    if (peer_.Covers(received->from)) {
      HearDatagram({received->bytes.data(), received->bytes.size()}, received->from);
    } else {
      const std::lock_guard lock(mutex_);
      ++num_strangers_;
    }
  }
}

void CommandChannel::HearDatagram(std::string_view text, const Endpoint& from) {
  const std::vector<std::string_view> lines = LinesOf(text);
  if (lines.size() > kMaxLines) {
    std::ostringstream fault;
    fault << "a datagram must have at most " << kMaxLines << " lines (got " << lines.size() << ")";
    receiver_.Answer(FaultAnswer({}, {fault.str()}), from);
    return;
  }
  for (const std::string_view each : lines) {
    if (each.starts_with(kAnswerBegin)) {
      const std::lock_guard lock(mutex_);
      ++num_answers_;
      continue;
    }
    // Parsed without holding the lock, so that a long line does not delay the run.
    const CommandLine line = ReadCommand(each, models_);
    const std::lock_guard lock(mutex_);
    Hear(each, line, from);
  }
}

void CommandChannel::Hear(std::string_view text, const CommandLine& line, const Endpoint& from) {
  if (HasBoth(line.tag) && IsRepeated(text, line.tag, from)) return;
  Answer answer{from, line.tag, std::string(text), std::nullopt};
  if (!line.command) {
    answer.text = FaultAnswer(line.tag, line.faults);
  } else if (requests_.size() == kMaxRequests) {
    // Not remembered, so that the command is accepted if it is sent again once there is room.
    receiver_.Answer(FaultAnswer(line.tag, {"too many commands are waiting (got one more than " +
                                            std::to_string(kMaxRequests) + ")"}),
                     from);
    return;
  } else {
    requests_.push_back({from, line.tag, *line.command});
    arrived_.notify_all();
  }
  if (answer.text) receiver_.Answer(*answer.text, from);
  if (HasBoth(line.tag)) Remember(std::move(answer));
}

bool CommandChannel::IsRepeated(std::string_view text,
                                const CommandTag& tag,
                                const Endpoint& from) {
  const auto known = Find(from, tag);
  if (known == answers_.end()) return false;
  if (known->line != text) {
    receiver_.Answer(FaultAnswer(tag, {"command: /id: must be another than that of another command "
                                       "of the session (got " +
                                       std::to_string(*tag.id) + ")"}),
                     from);
  } else if (known->text) {
    receiver_.Answer(*known->text, from);
  }
  return true;
}

std::deque<CommandChannel::Answer>::iterator CommandChannel::Find(const Endpoint& to,
                                                                  const CommandTag& tag) {
  return std::find_if(answers_.begin(), answers_.end(),
                      [&](const Answer& each) { return each.to == to && each.tag == tag; });
}

void CommandChannel::Send(const CommandRequest& request, const std::string& text) {
  const std::lock_guard lock(mutex_);
  receiver_.Answer(text, request.from);
  // The answer still exists, because Remember() never drops one whose command is waiting.
  if (HasBoth(request.tag)) Find(request.from, request.tag)->text = text;
}

void CommandChannel::Remember(Answer answer) {
  answers_.push_back(std::move(answer));
  if (answers_.size() <= kMaxAnswers) return;
  // Answers whose commands are waiting must stay; they are at most kMaxRequests and the one under
  // way.
  const auto oldest = std::find_if(answers_.begin(), answers_.end(),
                                   [](const Answer& each) { return each.text.has_value(); });
  if (oldest != answers_.end()) answers_.erase(oldest);
}

CommandLoop::CommandLoop(FrameMaker& maker,
                         std::vector<CommandSource*> sources,
                         bool lockstep,
                         const std::optional<std::filesystem::path>& log_file,
                         const std::string& scenario_xxh3)
    : maker_(maker), sources_(std::move(sources)), lockstep_(lockstep) {
  if (!log_file) return;
  if (std::filesystem::exists(*log_file)) {
    throw InputError("--commands-log: must not exist yet (got " + ShownPath(*log_file) + ")");
  }
  log_.emplace(FileToReplace(*log_file), 0);
  log_->Append(CommandLogHeader(scenario_xxh3));
}

std::optional<CommandLoop::Waiting> CommandLoop::NextOf(int timeout_ms) {
  for (CommandSource* source : sources_) {
    if (step_ && step_->source == source) continue;
    auto request = source->Next(0);
    if (request) return Waiting{source, std::move(*request)};
  }
  if (timeout_ms == 0) return std::nullopt;
  auto request = sources_.front()->Next(timeout_ms);
  if (!request) return std::nullopt;
  return Waiting{sources_.front(), std::move(*request)};
}

bool CommandLoop::IsStep(const Waiting& waiting) const {
  return lockstep_ && waiting.source == sources_.front() &&
         std::holds_alternative<Step>(waiting.request.command);
}

NextFrames CommandLoop::BeginFrames(std::int64_t stamp_ns,
                                    const std::function<bool()>& is_stopped) {
  while (lockstep_ && !step_) {
    if (is_stopped()) return NextFrames::kStop;
    auto waiting = NextOf(kPatience_ms);
    if (!waiting) continue;
    if (IsStep(*waiting)) {
      step_ = std::move(waiting);
    } else if (Handle(*waiting, stamp_ns)) {
      return NextFrames::kReset;
    }
  }
  for (int i = 0; i < kMaxPerFrame; ++i) {
    if (is_stopped()) return NextFrames::kStop;
    const auto waiting = NextOf(0);
    if (!waiting) break;
    if (Handle(*waiting, stamp_ns)) return NextFrames::kReset;
  }
  return NextFrames::kMake;
}

void CommandLoop::End(const std::string& reason) {
  std::optional<Waiting> waiting = std::move(step_);
  step_.reset();
  if (!waiting) waiting = NextOf(0);
  for (; waiting; waiting = NextOf(0)) waiting->source->Refuse(waiting->request, {reason});
  if (log_) Log(CommandLogEnd(num_logged_));
}

void CommandLoop::Log(const std::string& line) {
  try {
    log_->Append(line);
  } catch (const InputError& error) {
    log_fault_ =
        std::string(error.what()) + "; the log ends after " + Amount(num_logged_, "commands");
    log_.reset();
  }
}

bool CommandLoop::Handle(const Waiting& waiting, std::int64_t stamp_ns) {
  const auto& [source, request] = waiting;
  if (std::holds_alternative<Step>(request.command)) {
    source->Refuse(request,
                   {lockstep_ ? "command: step must come on the topic of --step-topic, for "
                                "which this run waits"
                              : "command: step needs --lockstep; this run does not wait for "
                                "steps"});
    return false;
  }
  const bool is_reset = std::holds_alternative<Reset>(request.command);
  const std::int64_t time_ns = is_reset ? 0 : stamp_ns;
  try {
    maker_.Apply(request.command, time_ns);
  } catch (const InputError& error) {
    source->Refuse(request, {error.what()});
    return false;
  }
  if (log_) Log(CommandLogLine({time_ns, request.command}, num_logged_ + 1));
  if (log_) ++num_logged_;
  source->Acknowledge(request, time_ns);
  return is_reset;
}

void CommandLoop::EndFrames(std::int64_t stamp_ns) {
  maker_.ForgetBefore(stamp_ns);
  if (!step_) return;
  step_->source->Acknowledge(step_->request, stamp_ns);
  step_.reset();
}

}  // namespace railcast
