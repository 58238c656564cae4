#pragma once

#include <string>
#include <vector>

#include "core/extras/dds/participant.h"

namespace railcast::dds {

/// An address of a network interface of this machine.
struct InterfaceAddress {
  std::string name;     ///< "eth0"
  std::string address;  ///< "192.168.1.5" or "2001:db8::5"
  bool is_loopback = false;

  [[nodiscard]] bool is_ipv6() const { return address.find(':') != std::string::npos; }
};

/// The addresses of all interfaces that are up, IPv4 first; without link-local IPv6.
[[nodiscard]] std::vector<InterfaceAddress> InterfaceAddresses();

/// Cyclone DDS's configuration of a domain, as XML. The environment (CYCLONEDDS_URI) adds nothing.
/// @param addresses Among which the interface must be.
/// @throws InputError "interface: rule (got value)" if it is not.
[[nodiscard]] std::string DomainConfig(const ParticipantSpec& spec,
                                       const std::vector<InterfaceAddress>& addresses);

}  // namespace railcast::dds
