#include "generator/extras/ros/twist_commands.h"

#include <utility>

#include "core/base/error.h"
#include "core/extras/ros/messages/geometry_messages.h"
#include "core/extras/ros/messages/message_type.h"
#include "generator/extras/ros/twist_message.h"

namespace railcast {
namespace {

dds::TopicSpec TwistTopic(const std::string& name) {
  const ros::MessageType& type = ros::TypeOf<ros::TwistStamped>();
  return {.name = name, .type = type.dds_name, .hash = type.hash};
}

}  // namespace

TwistCommands::TwistCommands(dds::Participant& participant,
                             std::string topic,
                             double deceleration_mps2)
    : participant_(participant),
      topic_(std::move(topic)),
      reader_(participant.AddReader(TwistTopic(topic_))),
      deceleration_mps2_(deceleration_mps2) {}

std::optional<CommandRequest> TwistCommands::Next(int /*timeout_ms*/) {
  while (const auto cdr = participant_.Take(reader_)) {
    try {
      return CommandRequest{{}, {}, CommandOfTwist(*cdr, deceleration_mps2_)};
    } catch (const InputError& error) {
      Refuse({}, {error.what()});
    }
  }
  return std::nullopt;
}

void TwistCommands::Acknowledge(const CommandRequest& /*request*/, std::int64_t /*time_ns*/) {
  ++counts_.done;
}

void TwistCommands::Refuse(const CommandRequest& /*request*/,
                           const std::vector<std::string>& faults) {
  ++counts_.refused;
  counts_.last_fault = faults.front();
}

}  // namespace railcast
