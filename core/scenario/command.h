#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "railcast/effects.h"
#include "railcast/objects.h"
#include "railcast/world_spec.h"

namespace railcast {

// The commands that a vehicle's controller may send to a running simulation. On the wire each is
// one JSON object per line, {"session": "k3v9", "id": 7, "command": "set_speed", "speed_mps": 10};
// see docs/commands.md.
//
// The default rates follow docs/physics.md 7.4: 0.5 m/s^2 is a service brake in shunting, 0.3 that
// of a slow freight train, 1.0 that of a multiple unit, 1.3 an emergency brake.

/// Changes the vehicle's speed at a constant rate and then keeps it. The direction does not change.
struct SetSpeed {
  double speed_mps{};
  double acceleration_mps2 = 0.5;  ///< Magnitude; also the deceleration if the new speed is lower.

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

/// Adds an object. Time 0 of its motion is the time at which the command takes effect. A mesh is
/// not allowed, since commands do not read files.
struct PlaceObject {
  ObjectSpec object;

  bool operator==(const PlaceObject&) const = default;
};

/// Removes an object of the scenario or a placed one.
struct RemoveObject {
  std::string name;

  bool operator==(const RemoveObject&) const = default;
};

/// Replaces the whole weather.
struct SetWeather {
  WeatherSpec weather;

  bool operator==(const SetWeather&) const = default;
};

/// Releases the next frame in lockstep.
struct Step {
  bool operator==(const Step&) const = default;
};

/// Resets the simulation to the scenario at time 0.
struct Reset {
  bool operator==(const Reset&) const = default;
};

using Command =
    std::variant<SetSpeed, Brake, Stop, PlaceObject, RemoveObject, SetWeather, Step, Reset>;

/// Longer lines are refused without being parsed: no command is that long, and parsing a long
/// hostile line takes much time.
inline constexpr std::size_t kMaxCommandBytes = 8192;

/// Identifies a command in its acknowledgement. A client gives both members, or neither if it does
/// not need to match acknowledgements to commands. It chooses a new session at each start.
struct CommandTag {
  std::optional<std::string> session;  ///< At most kMaxSessionBytes.
  std::optional<std::uint64_t> id;     ///< At most 2^53.

  bool operator==(const CommandTag&) const = default;
};
inline constexpr std::size_t kMaxSessionBytes = 64;

/// The result of reading a line.
struct CommandLine {
  CommandTag tag;  ///< For the acknowledgement; also read from faulty commands, if possible.
  std::optional<Command> command;   ///< Absent if there is a fault.
  std::vector<std::string> faults;  ///< "command: /speed_mps: must be >= 0 and <= 200 (got -1)"
};

/// Reads one line (with or without its end) or one whole datagram, as strictly as scenarios are
/// read. Never reads a file and never throws, whatever the line contains.
/// @param models Types that objects may have beside the shipped ones: the scenario's own.
[[nodiscard]] CommandLine ReadCommand(std::string_view line,
                                      const std::vector<ModelSpec>& models = {});

/// The command as a line without its end, with every default written out. Reading it back gives the
/// same command.
[[nodiscard]] std::string WriteCommand(const Command& command, const CommandTag& tag = {});

/// The name of a command on the wire, for example "set_speed".
[[nodiscard]] std::string CommandName(const Command& command);

}  // namespace railcast
