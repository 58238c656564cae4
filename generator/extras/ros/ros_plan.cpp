#include "generator/extras/ros/ros_plan.h"

#include <algorithm>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/stream/stream_encoder.h"

namespace railcast {
namespace {

void CheckNoneIsForRos(const StreamOptions& options, const SensorStreamSpec& stream) {
  for (const auto& [option, is_given] :
       {std::pair{"--domain", options.domain.has_value()},
        std::pair{"--interface", options.interface.has_value()},
        std::pair{"--receive-buffers", options.receive_buffers.has_value()},
        std::pair{"--commands-topic", options.commands_topic.has_value()},
        std::pair{"--step-topic", options.step_topic.has_value()}}) {
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

void CheckTopic(const std::string& option,
                const std::optional<std::string>& topic,
                const std::string& example) {
  if (!topic || dds::IsTopicName(*topic)) return;
  throw InputError(option + ": must be a topic of ROS 2: / and letters, digits and _, such as " +
                   example + " (got \"" + ShownText(*topic) + "\")");
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
  CheckTopic("--commands-topic", options.commands_topic, "/brake");
  CheckTopic("--step-topic", options.step_topic, "/step");
  const bool has_velocity = std::ranges::any_of(spec.sensors, [&](std::size_t sensor) {
    return PickSensor(scenario, streams[sensor].name).lidar.velocity.has_value();
  });
  spec.clouds = options.fields ? ros::ParseCloudSpec(*options.fields, has_velocity)
                               : ros::CloudSpec{.fields = UsualFields(has_velocity)};
  spec.participant = ParticipantOf(options, scenario.interfaces.ros2.value_or(Ros2Spec{}));
  return spec;
}

}  // namespace railcast
