#include "generator/live/ros_plan.h"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <string_view>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/stream/stream_encoder.h"

namespace railcast {
namespace {

constexpr const char* kDomainVariable = "ROS_DOMAIN_ID";

/// As ROS 2 reads it: the domain 0 where it is not set, or empty.
std::uint32_t DomainOfEnvironment() {
  const char* const value = std::getenv(kDomainVariable);
  const std::string_view text = value == nullptr ? "" : value;
  std::uint32_t domain = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), domain);
  const bool is_whole = read.ec == std::errc() && read.ptr == text.data() + text.size();
  if (text.empty() || (is_whole && domain <= dds::kMaxDomain)) return domain;
  throw InputError(std::string(kDomainVariable) + ": must be a whole number from 0 to " +
                   std::to_string(dds::kMaxDomain) + " (got \"" + ShownText(text) + "\")");
}

dds::ParticipantSpec ParticipantOf(const StreamOptions& options, const Ros2Spec& spec) {
  dds::ParticipantSpec participant;
  participant.node = "railcast";
  participant.interface = options.interface.value_or(spec.interface);
  const ReceiveBuffers buffers = options.receive_buffers
                                     ? ValueNamed<ReceiveBuffers>(*options.receive_buffers).value()
                                     : spec.receive_buffers;
  participant.has_large_buffers = buffers == ReceiveBuffers::kLarge;
  const std::optional<std::uint32_t> domain = options.domain ? options.domain : spec.domain;
  participant.domain = domain ? *domain : DomainOfEnvironment();
  return participant;
}

void CheckNoneIsForRos(const StreamOptions& options, const SensorStreamSpec& stream) {
  for (const auto& [option, is_given] :
       {std::pair{"--domain", options.domain.has_value()},
        std::pair{"--interface", options.interface.has_value()},
        std::pair{"--receive-buffers", options.receive_buffers.has_value()},
        std::pair{"--commands-topic", options.commands_topic.has_value()}}) {
    if (!is_given) continue;
    throw InputError(std::string(option) + ": is for protocol ros2 (got " +
                     std::string(NameOf(stream.protocol)) + ")");
  }
}

void CheckNoneIsForUdp(const StreamOptions& options) {
  for (const auto& [option, is_given] :
       {std::pair{"--to", !options.to.empty()}, std::pair{"--pcap", options.pcap.has_value()},
        std::pair{"--no-offload", options.sends_singly},
        std::pair{"--all-slots", options.has_all_slots}}) {
    if (!is_given) continue;
    throw InputError(std::string(option) +
                     ": must be left out with protocol ros2, which sends messages to whoever reads "
                     "their topics");
  }
}

void CheckTopic(const std::optional<std::string>& topic) {
  if (!topic || dds::IsTopicName(*topic)) return;
  throw InputError(
      "--commands-topic: must be a topic of ROS 2: / and letters, digits and _, such as /brake "
      "(got \"" +
      ShownText(*topic) + "\")");
}

}  // namespace

bool IsForRos(const std::string& fields) {
  return ValueNamed<ros::PointLayout>(fields).has_value();
}

std::optional<RosOutputSpec> PlanRos(const StreamOptions& options,
                                     const ScenarioSpec& scenario,
                                     const std::vector<SensorStreamSpec>& streams) {
  RosOutputSpec spec;
  for (const SensorStreamSpec& stream : streams) {
    if (stream.protocol == Protocol::kRos2) spec.sensors.push_back(stream.sensor);
  }
  if (spec.sensors.empty()) {
    CheckNoneIsForRos(options, streams.front());
    return std::nullopt;
  }
  if (spec.sensors.size() == streams.size()) CheckNoneIsForUdp(options);
  CheckTopic(options.commands_topic);
  const bool has_velocity = std::ranges::any_of(spec.sensors, [&](std::size_t sensor) {
    return PickSensor(scenario, streams[sensor].name).lidar.velocity.has_value();
  });
  spec.clouds = options.fields ? ros::ParseCloudSpec(*options.fields, has_velocity)
                               : ros::CloudSpec{.fields = UsualFields(has_velocity)};
  spec.participant = ParticipantOf(options, scenario.interfaces.ros2.value_or(Ros2Spec{}));
  return spec;
}

std::string PlaceText(const dds::ParticipantSpec& spec) {
  return "domain " + std::to_string(spec.domain) + ", on " +
         (spec.interface.empty() ? "loopback" : ShownText(spec.interface));
}

}  // namespace railcast
