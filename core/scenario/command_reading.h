#pragma once

#include <optional>

#include "core/scenario/command.h"
#include "core/scenario/json_reader.h"

namespace railcast {

/// Reads a command and its tag from one JSON object. Faults are added to the source.
/// @param tag Read even if the command is faulty.
[[nodiscard]] std::optional<Command> ReadCommandObject(JsonSource& source,
                                                       const Node& object,
                                                       CommandTag& tag);

[[nodiscard]] Json CommandJson(const Command& command, const CommandTag& tag);

}  // namespace railcast
