#include <cstddef>
#include <span>
#include <string>
#include <variant>

#include "core/base/error.h"
#include "core/scenario/command.h"
#include "generator/extras/dds/twist_message.h"
#include "tests/fuzz/fuzz_target.h"

namespace railcast {
namespace {

void ReadTwist(std::span<const std::byte> cdr) {
  constexpr double kDeceleration_mps2 = 0.75;
  try {
    const Command command = CommandOfTwist(cdr, kDeceleration_mps2);
    if (const auto* brake = std::get_if<Brake>(&command)) {
      Check(brake->deceleration_mps2 == kDeceleration_mps2, "braking is as the scenario says");
    } else {
      const auto& change = std::get<SetSpeed>(command);
      Check(change.speed_mps > 0.0 && change.speed_mps <= 200.0, "speeds are those of commands");
    }
  } catch (const InputError& error) {
    const std::string fault = error.what();
    Check(!fault.empty() && fault.size() <= 303, "a fault is short");
    Check(fault.find('\n') == std::string::npos, "a fault is one line");
  }
}

}  // namespace
}  // namespace railcast

/// a message of ROS 2 on the topic of commands.
RAILCAST_FUZZ_TARGET(twist) {
  railcast::ReadTwist(std::as_bytes(std::span(data, size)));
  return 0;
}
