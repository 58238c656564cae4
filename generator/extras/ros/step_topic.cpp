#include "generator/extras/ros/step_topic.h"

#include <algorithm>
#include <utility>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/extras/ros/messages/cdr.h"
#include "core/extras/ros/messages/geometry_messages.h"
#include "core/extras/ros/messages/message_type.h"

namespace railcast {
namespace {

dds::TopicSpec TimeTopic(const std::string& name) {
  const ros::MessageType& type = ros::TypeOf<ros::Time>();
  return {.name = name, .type = type.dds_name, .hash = type.hash};
}

}  // namespace

StepTopic::StepTopic(RosOutput& ros, std::string topic)
    : ros_(ros),
      topic_(std::move(topic)),
      reader_(ros.participant().AddReader(TimeTopic(topic_))) {}

void StepTopic::TakeMessages() {
  while (const auto cdr = ros_.participant().Take(reader_)) {
    try {
      const auto stamp = ros::FromCdr<ros::Time>(*cdr);
      const std::int64_t time_ns = stamp.sec * kNsPerS + stamp.nanosec - ros_.clock_ahead_ns();
      done_ns_ = std::max(done_ns_.value_or(time_ns), time_ns);
    } catch (const InputError& error) {
      ++faults_.count;
      faults_.last = error.what();
    }
  }
}

std::optional<CommandRequest> StepTopic::Next(int timeout_ms) {
  if (timeout_ms > 0) ros_.participant().WaitForMessage(reader_, timeout_ms);
  TakeMessages();
  const bool is_due = sent_ns_ ? done_ns_ >= sent_ns_ : done_ns_ && ros_.HasReaders();
  if (is_stepping_ || !is_due) return std::nullopt;
  is_stepping_ = true;
  return CommandRequest{{}, {}, Step{}};
}

void StepTopic::Acknowledge(const CommandRequest& /*request*/, std::int64_t time_ns) {
  // Once the run has begun anew, what was done before is nothing.
  if (sent_ns_ && time_ns < *sent_ns_) done_ns_.reset();
  sent_ns_ = time_ns;
  is_stepping_ = false;
}

void StepTopic::Refuse(const CommandRequest& /*request*/,
                       const std::vector<std::string>& /*faults*/) {}

}  // namespace railcast
