#include "generator/live/command_channel.h"

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
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
    const std::lock_guard lock(mutex_);
    if (!is_peer) {
      ++num_strangers_;
      continue;
    }
    std::string_view text(received->bytes.data(), received->bytes.size());
    while (!text.empty()) {
      const std::size_t end = std::min(text.find('\n'), text.size());
      if (end > 0) Hear(text.substr(0, end), received->from);
      text.remove_prefix(std::min(end + 1, text.size()));
    }
  }
}

void CommandChannel::Hear(std::string_view line, const Endpoint& from) {
  CommandLine read = ReadCommand(line);
  if (read.id && IsRepeated(from, *read.id)) return;
  if (!read.command) {
    Send(from, read.id, FaultAnswer(read.id, read.faults));
  } else if (requests_.size() == kMaxRequests) {
    Send(from, read.id,
         FaultAnswer(read.id, {"too many commands wait (got one more than " +
                               std::to_string(kMaxRequests) + ")"}));
  } else {
    if (read.id) answers_.push_back({from, *read.id, std::nullopt});
    requests_.push_back({from, read.id, std::move(*read.command)});
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
    answers_.push_back({to, *id, text});
  }
  while (answers_.size() > kMaxAnswers && answers_.front().text) answers_.pop_front();
}

}  // namespace railcast
