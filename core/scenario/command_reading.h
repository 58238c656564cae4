#pragma once

#include <optional>

#include "core/scenario/command.h"
#include "core/scenario/json_reader.h"

namespace railcast {

/// A command and its id from one JSON object. Faults go to the source.
/// @param id Read even if the command is faulty.
[[nodiscard]] std::optional<Command> ReadCommandObject(JsonSource& source,
                                                       const Node& object,
                                                       std::optional<std::uint64_t>& id);

[[nodiscard]] Json CommandJson(const Command& command, std::optional<std::uint64_t> id);

}  // namespace railcast
