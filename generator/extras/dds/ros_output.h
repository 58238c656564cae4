#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/extras/dds/participant.h"
#include "core/extras/ros/messages/frame_topics.h"
#include "core/io/datagrams.h"
#include "core/io/net/udp.h"
#include "generator/extras/dds/ros_writers.h"
#include "generator/live/live_extras.h"
#include "generator/live/live_run.h"
#include "generator/run/frame_maker.h"

namespace railcast {

/// What sensors of protocol ros2 tell, and where, and which commands are heard.
struct RosOutputSpec {
  dds::ParticipantSpec participant;
  ros::CloudSpec clouds;
  std::vector<std::size_t> sensors;  ///< Their numbers on the vehicle.
  std::optional<std::string> commands_topic;
  double deceleration_mps2{};  ///< Deceleration by these commands.
  std::optional<std::string> step_topic;
};

/// Commands that nodes of ROS 2 give on a topic. Nobody gets an answer; the end of a run counts
/// them.
class TopicCommands : public CommandSource {
 public:
  /// A line on what came; empty where there is nothing to say.
  [[nodiscard]] virtual std::string Text() const = 0;
};

/// Publishes the frames of a vehicle's sensors, its motion and the objects in sight on topics of
/// ROS 2: the same bytes that `sequence` writes into bags.
class RosOutput final : public LiveTopics {
 public:
  /// @param participant As dds::Join() made it of the spec.
  /// @param maker Must outlive this object.
  /// @throws InputError as ros::FrameTopics does.
  RosOutput(const RosOutputSpec& spec,
            std::unique_ptr<dds::Participant> participant,
            FrameMaker& maker);

  /// Hears commands and steps from now on.
  /// @throws InputError "--commands-topic: ..." as Participant::AddReader() does, or "--step-topic:
  /// ...".
  void Listen(const RosOutputSpec& spec);

  [[nodiscard]] dds::Participant& participant() { return writers_.participant(); }
  void Begin() override;

  void SetClockAhead(std::int64_t ahead_ns) override { clock_ahead_ns_ = ahead_ns; }
  [[nodiscard]] std::int64_t clock_ahead_ns() const { return clock_ahead_ns_; }

  /// Whether somebody reads a sensor's clouds.
  [[nodiscard]] bool HasReaders() const;

  [[nodiscard]] std::vector<LiveSensor> Sensors() override;

  void Finish() override;
  [[nodiscard]] std::vector<UdpSender::Counts> Delivered() const override;

  [[nodiscard]] CommandSource* steps() override { return steps_.get(); }
  [[nodiscard]] CommandSource* commands() override { return twists_.get(); }
  [[nodiscard]] std::string CommandsText() const override;

 private:
  struct Sensor {
    std::size_t number;  ///< On the vehicle.
    MadeFrame made;
    UdpSender::Counts counts;
  };
  void Make(std::size_t sensor, std::uint32_t frame, Datagrams& datagrams);

  FrameMaker& maker_;
  ros::FrameTopics topics_;
  RosWriters writers_;  ///< Writers of topics_.
  std::vector<Sensor> sensors_;
  std::int64_t clock_ahead_ns_{};
  std::unique_ptr<TopicCommands> twists_;  ///< Null where none are heard.
  std::unique_ptr<TopicCommands> steps_;   ///< Null where none are heard, either.
};

/// Hears commands that nodes of ROS 2 give on a topic of geometry_msgs/msg/TwistStamped.
/// @param participant Must outlive the result.
/// @param topic "/brake"
/// @param deceleration_mps2 As CommandOfTwist() takes it.
/// @throws InputError as Participant::AddReader() does.
[[nodiscard]] std::unique_ptr<TopicCommands> HearTwists(dds::Participant& participant,
                                                        const std::string& topic,
                                                        double deceleration_mps2);

/// Hears steps that a node of ROS 2 gives on a topic of builtin_interfaces/msg/Time, by the stamps
/// of the frames that it is done with.
///
/// The next frames come once a message has said that those before them are done with: a stamp not
/// before theirs. A message that comes twice therefore does not let two frames come, and a later
/// time than that of any frame lets frames come until then. The first frames wait for any message,
/// and until somebody reads clouds, so that they are not lost.
/// @param ros Must outlive the result.
/// @throws InputError as Participant::AddReader() does.
[[nodiscard]] std::unique_ptr<TopicCommands> HearSteps(RosOutput& ros, const std::string& topic);

}  // namespace railcast
