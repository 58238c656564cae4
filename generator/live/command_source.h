#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/scenario/command.h"
#include "railcast/io/stream.h"

namespace railcast {

/// A command that a peer asks for.
struct CommandRequest {
  Endpoint from;
  CommandTag tag;
  Command command;
};

/// Where a live run gets its commands from.
class CommandSource {
 public:
  virtual ~CommandSource() = default;

  /// Returns the next request, waiting up to `timeout_ms` for it where the source can wait; 0 does
  /// not wait.
  [[nodiscard]] virtual std::optional<CommandRequest> Next(int timeout_ms) = 0;

  /// Answers that a command took effect, and at which simulation time.
  virtual void Acknowledge(const CommandRequest& request, std::int64_t time_ns) = 0;
  /// Answers why a command was refused.
  virtual void Refuse(const CommandRequest& request, const std::vector<std::string>& faults) = 0;
};

}  // namespace railcast
