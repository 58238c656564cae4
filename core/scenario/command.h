#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/detect/detect_spec.h"
#include "core/rail/world_spec.h"

namespace railcast {

// What a vehicle's controller may tell a simulation while it runs. Wire form: one JSON object a
// line, {"session": "k3v9", "id": 7, "command": "set_speed", "speed_mps": 10}; docs/commands.md.
//
// Rates are those of physics.md 7.4: 0.5 m/s^2 is a shunting or freight service brake, 1.0 that of
// a multiple unit, 1.3 an emergency brake.

/// Changes the vehicle's speed at a constant rate and keeps it then; its direction stays.
struct SetSpeed {
  double speed_mps{};
  double acceleration_mps2 = 0.5;  ///< Also to slow down.

  bool operator==(const SetSpeed&) const = default;
};

/// Brakes to a standstill.
struct Brake {
  double deceleration_mps2 = 0.5;

  bool operator==(const Brake&) const = default;
};

/// Brakes to a standstill with the emergency brake, at kEmergencyDeceleration_mps2.
struct Stop {
  bool operator==(const Stop&) const = default;
};
inline constexpr double kEmergencyDeceleration_mps2 = 1.3;

/// Adds an object; its motion's time 0 is when the command takes effect. It may be no mesh: a
/// command reads no files.
struct PlaceObject {
  ObjectSpec object;

  bool operator==(const PlaceObject&) const = default;
};

/// Takes away an object of the scenario or a placed one.
struct RemoveObject {
  std::string name;

  bool operator==(const RemoveObject&) const = default;
};

/// Replaces the whole weather.
struct SetWeather {
  WeatherSpec weather;

  bool operator==(const SetWeather&) const = default;
};

/// Lets the next frame come, in lockstep.
struct Step {
  bool operator==(const Step&) const = default;
};

/// Back to the scenario as it is at time 0.
struct Reset {
  bool operator==(const Reset&) const = default;
};

using Command =
    std::variant<SetSpeed, Brake, Stop, PlaceObject, RemoveObject, SetWeather, Step, Reset>;

/// Longer lines are refused unread: no command needs that much, and reading a long hostile one
/// takes long.
inline constexpr std::size_t kMaxCommandBytes = 8192;

/// How a client tells its commands apart: both, or neither where it wants no acknowledgement that
/// it can tell from others. A session is what the client chose when it started.
struct CommandTag {
  std::optional<std::string> session;  ///< At most kMaxSessionBytes.
  std::optional<std::uint64_t> id;     ///< At most 2^53.

  bool operator==(const CommandTag&) const = default;
};
inline constexpr std::size_t kMaxSessionBytes = 64;

/// A line as it was understood.
struct CommandLine {
  CommandTag tag;  ///< For the acknowledgement, as far as it can be read also of a faulty command.
  std::optional<Command> command;   ///< Absent if there is a fault.
  std::vector<std::string> faults;  ///< "command: /speed_mps: must be >= 0 and <= 200 (got -1)"
};

/// Reads one line (with or without its end), or one whole datagram, as strictly as scenarios are
/// read. Whatever it holds, it reads no file and does not throw.
[[nodiscard]] CommandLine ReadCommand(std::string_view line);

/// The command as a line without its end, every default in place. Reading it back gives the same
/// command.
[[nodiscard]] std::string WriteCommand(const Command& command, const CommandTag& tag = {});

/// "set_speed", ...
[[nodiscard]] std::string CommandName(const Command& command);

}  // namespace railcast
