#include "generator/extras/dds/ros_options.h"

#include <charconv>
#include <cstdlib>
#include <string_view>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/program/command_line.h"

namespace railcast {
namespace {

constexpr const char* kDomainVariable = "ROS_DOMAIN_ID";

/// As ROS 2 reads it: the domain 0 where it is not set, or empty.
std::uint32_t DomainOfEnvironment() {
  const char* const value = std::getenv(kDomainVariable);
  const std::string_view text = value == nullptr ? "" : value;
  std::uint32_t domain = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), domain);
  const bool is_whole = read.ec == std::errc() && read.ptr == text.data() + text.size();
  if (text.empty() || (is_whole && domain <= dds::kMaxDomain)) return domain;
  throw InputError(std::string(kDomainVariable) + ": must be a whole number from 0 to " +
                   std::to_string(dds::kMaxDomain) + " (got \"" + ShownText(text) + "\")");
}

}  // namespace

void AddRosOptions(ProgramOptions& command, RosOptions& options) {
  command
      .AddOption("--domain", options.domain,
                 "With protocol ros2: domain to publish in; default: the scenario's, else "
                 "ROS_DOMAIN_ID, else 0")
      .Check(Whole({0, 232}));
  command.AddOption("--interface", options.interface,
                    "With protocol ros2: name or address of the network interface to publish "
                    "through; default: the scenario's, else loopback");
  command
      .AddOption("--receive-buffers", options.receive_buffers,
                 "With protocol ros2, buffers of the readers' sockets: usual, Linux's default of "
                 "208 KiB; or large, 1 MiB or more in each reader, which gives the least latency; "
                 "default: the scenario's")
      .Check(Named(NamesOf<ReceiveBuffers>()));
}

dds::ParticipantSpec ParticipantOf(const RosOptions& options, const Ros2Spec& spec) {
  dds::ParticipantSpec participant;
  participant.node = "railcast";
  participant.interface = options.interface.value_or(spec.interface);
  const ReceiveBuffers buffers = options.receive_buffers
                                     ? ValueNamed<ReceiveBuffers>(*options.receive_buffers).value()
                                     : spec.receive_buffers;
  participant.has_large_buffers = buffers == ReceiveBuffers::kLarge;
  const std::optional<std::uint32_t> domain = options.domain ? options.domain : spec.domain;
  participant.domain = domain ? *domain : DomainOfEnvironment();
  return participant;
}

std::unique_ptr<dds::Participant> JoinDomain(const dds::ParticipantSpec& spec) {
  return AtPlace("protocol ros2: ", [&] { return dds::Join(spec); });
}

std::string PlaceText(const dds::ParticipantSpec& spec) {
  return "domain " + std::to_string(spec.domain) + ", on " +
         (spec.interface.empty() ? "loopback" : ShownText(spec.interface));
}

}  // namespace railcast
