#pragma once

#include <cstddef>
#include <span>

#include "core/scenario/command.h"

namespace railcast {

/// Returns the command that a node of ROS 2 gives by a message of geometry_msgs/msg/TwistStamped:
/// `linear.x` is the speed to come to, 0 = to a standstill, in the direction of travel. Nothing
/// else of the message counts.
/// @param cdr The message's bytes.
/// @param deceleration_mps2 With which the vehicle brakes, or accelerates.
/// @throws InputError "place: rule (got value)" if the bytes are no such message, or not a speed
///   that a command may name.
[[nodiscard]] Command CommandOfTwist(std::span<const std::byte> cdr, double deceleration_mps2);

}  // namespace railcast
