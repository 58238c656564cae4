#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "generator/extras/ros/ros_output.h"
#include "generator/live/command_source.h"

namespace railcast {

/// Steps that a node of ROS 2 gives on a topic of builtin_interfaces/msg/Time, by the stamps of the
/// frames that it is done with.
///
/// The next frames come once a message has said that those before them are done with: a stamp not
/// before theirs. A message that comes twice therefore does not let two frames come, and a later
/// time than that of any frame lets frames come until then. The first frames wait for any message,
/// and until somebody reads clouds, so that they are not lost.
class StepTopic final : public CommandSource {
 public:
  /// @param ros Must outlive this object.
  /// @throws InputError as Participant::AddReader() does.
  StepTopic(RosOutput& ros, std::string topic);

  [[nodiscard]] std::optional<CommandRequest> Next(int timeout_ms) override;
  void Acknowledge(const CommandRequest& request, std::int64_t time_ns) override;
  void Refuse(const CommandRequest& request, const std::vector<std::string>& faults) override;

  [[nodiscard]] const std::string& topic() const { return topic_; }
  /// Messages that could not be read.
  struct Faults {
    std::uint64_t count{};
    std::string last;
  };
  [[nodiscard]] const Faults& faults() const { return faults_; }

 private:
  void TakeMessages();

  RosOutput& ros_;
  std::string topic_;
  std::size_t reader_;
  std::optional<std::int64_t> done_ns_;  ///< The latest stamp that was done with.
  std::optional<std::int64_t> sent_ns_;  ///< The stamp of the frames that were sent last.
  bool is_stepping_ = false;             ///< A step is under way.
  Faults faults_;
};

}  // namespace railcast
