#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/extras/ros/dds/participant.h"
#include "generator/live/command_source.h"

namespace railcast {

/// Commands that nodes of ROS 2 give on a topic. Nobody gets an answer; the summary counts them.
class TwistCommands final : public CommandSource {
 public:
  /// @param participant Must outlive this object.
  /// @param topic "/brake"
  /// @param deceleration_mps2 As CommandOfTwist() takes it.
  /// @throws InputError as Participant::AddReader() does.
  TwistCommands(dds::Participant& participant, std::string topic, double deceleration_mps2);

  [[nodiscard]] std::optional<CommandRequest> Next(int timeout_ms) override;
  void Acknowledge(const CommandRequest& request, std::int64_t time_ns) override;
  void Refuse(const CommandRequest& request, const std::vector<std::string>& faults) override;

  struct Counts {
    std::uint64_t done{};
    std::uint64_t refused{};
    std::string last_fault;  ///< Of those refused.
  };
  [[nodiscard]] const std::string& topic() const { return topic_; }
  [[nodiscard]] const Counts& counts() const { return counts_; }

 private:
  dds::Participant& participant_;
  std::string topic_;
  std::size_t reader_;
  double deceleration_mps2_;
  Counts counts_;
};

}  // namespace railcast
