// What protocol ros2 adds to live runs.

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/io/stream/stream_encoder.h"
#include "core/scenario/sensors.h"
#include "generator/extras/dds/ros_options.h"
#include "generator/extras/dds/ros_output.h"
#include "generator/live/live_extras.h"
#include "generator/live/live_options.h"
#include "generator/live/live_streams.h"

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

void AddTopicOptions(ProgramOptions& stream, StreamOptions& options) {
  AddRosOptions(stream, options);
  stream.AddOption("--commands-topic", options.commands_topic,
                   "With protocol ros2: topic of geometry_msgs/msg/TwistStamped on which to "
                   "receive commands, such as /brake; default: none");
  stream.AddOption("--step-topic", options.step_topic,
                   "With protocol ros2 and --lockstep: topic of builtin_interfaces/msg/Time, "
                   "such as /step, on which to receive the stamp of each frame that has been "
                   "processed; the next frame waits for it");
}

bool NamesLayout(const std::string& fields) {
  return ValueNamed<ros::PointLayout>(fields).has_value();
}

std::unique_ptr<LiveTopics> OpenRosOutput(const RosOutputSpec& spec,
                                          std::unique_ptr<dds::Participant>& participant,
                                          FrameMaker& maker) {
  Check(participant != nullptr, "the topics of a plan are opened once");
  auto output = AtPlace("protocol ros2: ", [&] {
    return std::make_unique<RosOutput>(spec, std::move(participant), maker);
  });
  output->Listen(spec);
  return output;
}

std::optional<TopicsPlan> PlanTopics(const StreamOptions& options,
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
  const Ros2Spec interface = scenario.interfaces.ros2.value_or(Ros2Spec{});
  spec.participant = ParticipantOf(options, interface);
  spec.commands_topic = options.commands_topic;
  spec.deceleration_mps2 = interface.deceleration_mps2;
  spec.step_topic = options.step_topic;
  // A std::function can be copied, what it holds is shared.
  auto joined = std::make_shared<std::unique_ptr<dds::Participant>>(JoinDomain(spec.participant));
  return TopicsPlan{
      .place = PlaceText(spec.participant),
      .open = [spec, joined](FrameMaker& maker) { return OpenRosOutput(spec, *joined, maker); }};
}

}  // namespace

void AddDds(LiveExtras& extras) {
  extras.ros = {.add_options = AddTopicOptions, .has_fields = NamesLayout, .plan = PlanTopics};
}

}  // namespace railcast
