#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/extras/ros/dds/participant.h"
#include "core/extras/ros/messages/frame_topics.h"
#include "core/io/datagrams.h"
#include "core/io/net/udp.h"
#include "generator/extras/ros/ros_writers.h"
#include "generator/live/live_run.h"
#include "generator/run/frame_maker.h"

namespace railcast {

/// What sensors of protocol ros2 tell, and where.
struct RosOutputSpec {
  dds::ParticipantSpec participant;
  ros::CloudSpec clouds;
  std::vector<std::size_t> sensors;  ///< Their numbers on the vehicle.
};

/// Publishes the frames of a vehicle's sensors, its motion and the objects in sight on topics of
/// ROS 2: the same bytes that `sequence` writes into bags.
class RosOutput {
 public:
  /// @param participant As dds::Join() made it of the spec.
  /// @param maker Must outlive this object.
  /// @throws InputError as ros::FrameTopics does.
  RosOutput(const RosOutputSpec& spec,
            std::unique_ptr<dds::Participant> participant,
            FrameMaker& maker);

  [[nodiscard]] dds::Participant& participant() { return writers_.participant(); }
  /// Tells the name of the node and what holds for the whole run, once all topics are there.
  void Begin();

  /// Sets how far the stamps of all messages are ahead of simulation time: time 0 since 1970 where
  /// they state the time of day. They are not ahead unless set.
  void SetClockAhead(std::int64_t ahead_ns) { clock_ahead_ns_ = ahead_ns; }
  [[nodiscard]] std::int64_t clock_ahead_ns() const { return clock_ahead_ns_; }

  /// Whether somebody reads a sensor's clouds.
  [[nodiscard]] bool HasReaders() const;

  /// Returns the sensors for RunLive(), valid as long as this object.
  [[nodiscard]] std::vector<LiveSensor> Sensors();

  /// Waits a second at most for readers that have not received everything.
  void Finish();
  /// Numbers of messages, in the order of Sensors().
  /// @pre Nothing is being sent.
  [[nodiscard]] std::vector<UdpSender::Counts> Delivered() const;

 private:
  struct Sensor {
    std::size_t number;  ///< On the vehicle.
    MadeFrame made;
    UdpSender::Counts counts;
  };
  void Make(std::size_t sensor, std::uint32_t frame, Datagrams& datagrams);

  FrameMaker& maker_;
  ros::FrameTopics topics_;
  RosWriters writers_;  ///< Of topics_.
  std::vector<Sensor> sensors_;
  std::int64_t clock_ahead_ns_{};
};

}  // namespace railcast
