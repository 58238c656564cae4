#include "generator/live/live_options.h"

#include <chrono>
#include <iostream>

#include "core/base/error.h"
#include "core/program/command_line.h"

namespace railcast {

void AddCommandOptions(ProgramOptions& command, CommandOptions& options) {
  command
      .AddOption("--commands-port", options.commands_port,
                 "UDP port on which to receive commands as lines of JSON; default: none")
      .Check(Whole({1, 65535}));
  command.AddOption("--commands-from", options.commands_from,
                    "HOST or HOST:PORT whose commands are accepted; default: this machine only");
  command.AddFlag("--lockstep", options.lockstep, "Wait for the command `step` before each frame");
}

std::unique_ptr<CommandChannel> OpenChannel(const CommandOptions& options,
                                            const std::vector<ModelSpec>& models) {
  if (!options.commands_port) return nullptr;
  Endpoint peer = AtPlace("--commands-from: ", [&] {
    return ParseEndpoint(options.commands_from.value_or("127.0.0.1"), 0);
  });
  // A socket on the loopback address cannot be reached from other machines.
  const bool is_ipv4 = peer.address.is_ipv4();
  const Endpoint at = ParseEndpoint(
      peer.is_loopback() ? (is_ipv4 ? "127.0.0.1" : "::1") : (is_ipv4 ? "0.0.0.0" : "::"),
      *options.commands_port);
  auto channel = AtPlace("--commands-port: ",
                         [&] { return std::make_unique<CommandChannel>(at, peer, models); });
  std::cout << "commands at " << EndpointText(channel->at()) << "\n";
  return channel;
}

std::uint32_t NextRunNumber() {
  // Counted in milliseconds, so that a later start has a larger number even after many resets.
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return static_cast<std::uint32_t>(
      std::chrono::duration_cast<std::chrono::milliseconds>(now).count());
}

}  // namespace railcast
