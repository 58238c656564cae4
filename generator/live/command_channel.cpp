#include "generator/live/command_channel.h"

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <span>
#include <sstream>
#include <string_view>
#include <utility>

namespace railcast {
namespace {

using Json = nlohmann::ordered_json;

Json AnswerTo(std::optional<std::uint64_t> id, bool is_done) {
  Json answer;
  if (id) answer["id"] = *id;
  answer["ok"] = is_done;
  return answer;
}

std::string FaultAnswer(std::optional<std::uint64_t> id, const std::vector<std::string>& faults) {
  Json answer = AnswerTo(id, false);
  answer["faults"] = faults;
  // A fault may quote what is no UTF-8.
  return answer.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

/// Those that are not empty.
std::vector<std::string_view> LinesOf(std::span<const char> bytes) {
  std::vector<std::string_view> lines;
  std::string_view text(bytes.data(), bytes.size());
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    if (end > 0) lines.push_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

}  // namespace

CommandChannel::CommandChannel(const Endpoint& at, const Endpoint& peer)
    : receiver_(at), peer_(peer), thread_([this] { Listen(); }) {}

CommandChannel::~CommandChannel() {
  receiver_.Interrupt();
  thread_.join();
}

std::uint64_t CommandChannel::num_strangers() const {
  const std::lock_guard lock(mutex_);
  return num_strangers_;
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
  Json answer = AnswerTo(request.id, true);
  answer["command"] = CommandName(request.command);
  answer["time_ns"] = time_ns;
  const std::lock_guard lock(mutex_);
  Send(request.from, request.id, answer.dump() + "\n");
}

void CommandChannel::Refuse(const CommandRequest& request, const std::vector<std::string>& faults) {
  const std::lock_guard lock(mutex_);
  Send(request.from, request.id, FaultAnswer(request.id, faults));
}

void CommandChannel::Listen() {
  while (true) {
    const auto received = receiver_.Receive(-1);
    if (receiver_.is_interrupted()) return;
    if (!received) continue;
    const bool is_peer = received->from.address == peer_.address &&
                         (peer_.port == 0 || received->from.port == peer_.port);
    if (!is_peer) {
      const std::lock_guard lock(mutex_);
      ++num_strangers_;
      continue;
    }
    const std::vector<std::string_view> lines = LinesOf(received->bytes);
    if (lines.size() > kMaxLines) {
      std::ostringstream fault;
      fault << "a datagram must have at most " << kMaxLines << " lines (got " << lines.size()
            << ")";
      receiver_.Answer(FaultAnswer({}, {fault.str()}), received->from);
      continue;
    }
    for (const std::string_view text : lines) {
      // Unlocked: the run must not wait for a long one.
      const CommandLine line = ReadCommand(text);
      const std::lock_guard lock(mutex_);
      Hear(line, received->from);
    }
  }
}

void CommandChannel::Hear(const CommandLine& line, const Endpoint& from) {
  if (line.id && IsRepeated(from, *line.id)) return;
  if (!line.command) {
    Send(from, line.id, FaultAnswer(line.id, line.faults));
  } else if (requests_.size() == kMaxRequests) {
    Send(from, line.id,
         FaultAnswer(line.id, {"too many commands wait (got one more than " +
                               std::to_string(kMaxRequests) + ")"}));
  } else {
    if (line.id) Remember(from, *line.id, std::nullopt);
    requests_.push_back({from, line.id, *line.command});
    arrived_.notify_all();
  }
}

bool CommandChannel::IsRepeated(const Endpoint& from, std::uint64_t id) {
  const auto answer = std::find_if(answers_.begin(), answers_.end(), [&](const Answer& each) {
    return each.to == from && each.id == id;
  });
  if (answer == answers_.end()) return false;
  if (answer->text) receiver_.Answer(*answer->text, from);
  return true;
}

void CommandChannel::Send(const Endpoint& to,
                          std::optional<std::uint64_t> id,
                          const std::string& text) {
  receiver_.Answer(text, to);
  if (!id) return;
  const auto waiting = std::find_if(answers_.begin(), answers_.end(), [&](const Answer& each) {
    return each.to == to && each.id == *id;
  });
  if (waiting != answers_.end()) {
    waiting->text = text;
  } else {
    Remember(to, *id, text);
  }
}

void CommandChannel::Remember(const Endpoint& to,
                              std::uint64_t id,
                              std::optional<std::string> text) {
  answers_.push_back({to, id, std::move(text)});
  if (answers_.size() <= kMaxAnswers) return;
  // Those that wait are at most kMaxRequests, and needed.
  const auto oldest = std::find_if(answers_.begin(), answers_.end(),
                                   [](const Answer& each) { return each.text.has_value(); });
  if (oldest != answers_.end()) answers_.erase(oldest);
}

}  // namespace railcast
