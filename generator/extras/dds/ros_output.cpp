#include "generator/extras/dds/ros_output.h"

#include <string>
#include <utility>

#include "core/base/error.h"
#include "core/extras/ros/messages/sensor_messages.h"
#include "core/scenario/sensors.h"
#include "generator/extras/ros/run_topics.h"

namespace railcast {
namespace {

/// What the sensors of protocol ros2 tell, and the camera if the sensor that it belongs to is one
/// of them.
ros::TopicsSpec SpecOfTopics(const RosOutputSpec& spec, const FrameMaker& maker) {
  ros::TopicsSpec all = TopicsSpecOf(maker.scenario(), *maker.StateAt(0).world, spec.clouds,
                                     ros::ImageEncoding::kJpeg);
  std::vector<ros::TopicSensor> published;
  for (const std::size_t number : spec.sensors) published.push_back(all.sensors.at(number));
  all.sensors = std::move(published);
  if (spec.sensors.front() != 0) all.camera.reset();
  return all;
}

void AddToStamps(std::int64_t ahead_ns, MadeFrame& made) {
  made.frame.stamp_ns += ahead_ns;
  if (made.has_image) made.image.stamp_ns += ahead_ns;
  const auto add = [ahead_ns](auto& sensors) {
    for (auto& samples : sensors) {
      for (auto& sample : samples) sample.time_ns += ahead_ns;
    }
  };
  add(made.motion.imus);
  add(made.motion.gnss);
  add(made.motion.odometers);
}

std::vector<dds::TopicSpec> SpecsOf(const std::vector<ros::Topic>& topics) {
  std::vector<dds::TopicSpec> specs;
  for (const ros::Topic& topic : topics) {
    specs.push_back({.name = topic.name,
                     .type = topic.type.dds_name,
                     .hash = topic.type.hash,
                     .is_latched = topic.is_latched});
  }
  return specs;
}

}  // namespace

RosOutput::RosOutput(const RosOutputSpec& spec,
                     std::unique_ptr<dds::Participant> participant,
                     FrameMaker& maker)
    : maker_(maker),
      topics_(SpecOfTopics(spec, maker)),
      writers_(std::move(participant), SpecsOf(topics_.topics())) {
  for (const std::size_t number : spec.sensors) sensors_.push_back({number, {}, {}});
}

void RosOutput::Listen(const RosOutputSpec& spec) {
  if (spec.commands_topic) {
    twists_ = AtPlace("--commands-topic: ", [&] {
      return HearTwists(participant(), *spec.commands_topic, spec.deceleration_mps2);
    });
  }
  if (spec.step_topic) {
    steps_ = AtPlace("--step-topic: ", [&] { return HearSteps(*this, *spec.step_topic); });
  }
}

std::string RosOutput::CommandsText() const {
  return (twists_ ? twists_->Text() : "") + (steps_ ? steps_->Text() : "");
}

void RosOutput::Begin() {
  writers_.participant().Announce();
  const std::int64_t begin_ns =
      maker_.pattern(sensors_.front().number).StampNs(0) + clock_ahead_ns_;
  for (const ros::TopicMessage& message : topics_.First(begin_ns)) {
    static_cast<void>(writers_.Write(message.topic, message.cdr));
  }
}

void RosOutput::Make(std::size_t sensor, std::uint32_t frame, Datagrams& datagrams) {
  const std::size_t number = sensors_[sensor].number;
  MadeFrame& made = sensors_[sensor].made;
  maker_.Begin(number, frame)(made);
  // On the threads that scan.
  maker_.simulator(number).Execute([&] {
    const std::int64_t last_ns = made.frame.stamp_ns + std::int64_t{made.frame.duration_ns};
    AddToStamps(clock_ahead_ns_, made);
    for (const ros::TopicMessage& message : MessagesOf(topics_, sensor, made)) {
      // They leave when the frame's last firing does.
      AppendMessage(message.topic, message.cdr, last_ns, datagrams);
    }
  });
}

std::vector<LiveSensor> RosOutput::Sensors() {
  std::vector<LiveSensor> sensors;
  const std::vector<std::string> names = SensorNames(maker_.scenario());
  for (std::size_t i = 0; i < sensors_.size(); ++i) {
    Sensor& sensor = sensors_[i];
    const ScanPattern& pattern = maker_.pattern(sensor.number);
    sensors.push_back(
        {.name = names[sensor.number],
         .period_ns = pattern.PeriodNs(),
         .stamp_ns = [&pattern](std::uint32_t frame) { return pattern.StampNs(frame); },
         .make = [this, i](std::uint32_t frame,
                           Datagrams& datagrams) { Make(i, frame, datagrams); },
         .send =
             [this, &sensor](const Datagrams& datagrams, std::span<const Datagrams::Item> items) {
               writers_.Send(datagrams, items, sensor.counts);
             },
         .sends = "messages",
         .frame = &sensor.made.frame});
  }
  return sensors;
}

bool RosOutput::HasReaders() const {
  const std::string& clouds = ros::TypeOf<ros::PointCloud2>().name;
  for (std::size_t i = 0; i < topics_.topics().size(); ++i) {
    if (topics_.topics()[i].type.name == clouds && writers_.HasReaders(i)) return true;
  }
  return false;
}

void RosOutput::Finish() {
  writers_.Finish();
}

std::vector<UdpSender::Counts> RosOutput::Delivered() const {
  std::vector<UdpSender::Counts> delivered;
  for (const Sensor& sensor : sensors_) delivered.push_back(sensor.counts);
  return delivered;
}

}  // namespace railcast
