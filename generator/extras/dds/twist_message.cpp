#include "generator/extras/dds/twist_message.h"

#include <nlohmann/json.hpp>

#include <utility>

#include "core/base/error.h"
#include "core/extras/ros/messages/cdr.h"
#include "core/extras/ros/messages/geometry_messages.h"

namespace railcast {

Command CommandOfTwist(std::span<const std::byte> cdr, double deceleration_mps2) {
  const double speed_mps = ros::FromCdr<ros::TwistStamped>(cdr).twist.linear.x;
  if (speed_mps == 0.0) return Brake{deceleration_mps2};
  // The rules of speeds stand where those of commands do. JSON writes what is no number as null.
  const nlohmann::json line = {
      {"command", "set_speed"}, {"speed_mps", speed_mps}, {"acceleration_mps2", deceleration_mps2}};
  CommandLine read = ReadCommand(line.dump());
  if (!read.command) throw InputError(read.faults.front());
  return *std::move(read.command);
}

}  // namespace railcast
