#pragma once

#include <string>
#include <vector>

#include "core/io/dds/participant.h"

namespace railcast::dds {

/// An IPv4 address of a network interface of this machine.
struct InterfaceAddress {
  std::string name;     ///< "eth0"
  std::string address;  ///< "192.168.1.5"
  bool is_loopback = false;
};

/// Those of all interfaces that are up.
[[nodiscard]] std::vector<InterfaceAddress> InterfaceAddresses();

/// Cyclone DDS's configuration of a domain, as XML. The environment (CYCLONEDDS_URI) adds nothing.
/// @param addresses Among which the interface must be.
/// @throws InputError "interface: rule (got value)" if it is not.
[[nodiscard]] std::string DomainConfig(const ParticipantSpec& spec,
                                       const std::vector<InterfaceAddress>& addresses);

}  // namespace railcast::dds
