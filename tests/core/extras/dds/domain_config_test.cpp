#include "core/extras/dds/domain_config.h"

#include <gtest/gtest.h>

#include "tests/core/io/message_of.h"

namespace railcast {
namespace {

const std::vector<dds::InterfaceAddress> kInterfaces = {{"lo", "127.0.0.1", true},
                                                        {"eth0", "10.0.0.2", false}};

std::string ConfigWith(const dds::ParticipantSpec& spec) {
  return dds::DomainConfig(spec, kInterfaces);
}

TEST(DomainConfig, StaysOnLoopbackWithoutMulticastUnlessToldOtherwise) {
  const std::string loopback = ConfigWith({});
  EXPECT_NE(loopback.find("<NetworkInterface address=\"127.0.0.1\"/></Interfaces>"
                          "<AllowMulticast>false</AllowMulticast>"),
            std::string::npos);
  EXPECT_NE(loopback.find("<Peers><Peer Address=\"127.0.0.1\"/></Peers>"), std::string::npos);
  EXPECT_EQ(loopback, ConfigWith({.interface = "lo"}));
  EXPECT_EQ(loopback, ConfigWith({.interface = "127.0.0.1"}));
}

TEST(DomainConfig, UsesTheInterfaceOfThatNameOrAddressAndItsMulticast) {
  const std::string network = ConfigWith({.interface = "eth0"});
  EXPECT_EQ(network, ConfigWith({.interface = "10.0.0.2"}));
  EXPECT_NE(network.find("<NetworkInterface address=\"10.0.0.2\"/>"), std::string::npos);
  EXPECT_EQ(network.find("AllowMulticast"), std::string::npos);
  EXPECT_EQ(network.find("Peer"), std::string::npos);
}

TEST(DomainConfig, SpeaksIpv6WhereTheAddressIsOne) {
  const std::vector<dds::InterfaceAddress> interfaces = {
      {"lo", "127.0.0.1", true}, {"lo", "::1", true}, {"eth0", "2001:db8::2", false}};
  const auto config = [&](const std::string& interface) {
    return dds::DomainConfig({.interface = interface}, interfaces);
  };
  EXPECT_NE(config("::1").find("<NetworkInterface address=\"::1\"/></Interfaces>"
                               "<Transport>udp6</Transport><AllowMulticast>false"),
            std::string::npos);
  EXPECT_NE(config("::1").find("<Peer Address=\"[::1]\"/>"), std::string::npos);
  EXPECT_NE(config("eth0").find("udp6"), std::string::npos) << "it has no other";
  EXPECT_EQ(config("lo").find("udp6"), std::string::npos);
  EXPECT_EQ(config("").find("udp6"), std::string::npos);
}

TEST(DomainConfig, LimitsBurstsUnlessReadersHaveLargeBuffers) {
  EXPECT_NE(ConfigWith({}).find("<MaxInitTransmit>0</MaxInitTransmit>"), std::string::npos);
  EXPECT_EQ(ConfigWith({.has_large_buffers = true}).find("BurstSize"), std::string::npos);
}

TEST(DomainConfig, RefusesWhatIsNoInterface) {
  EXPECT_EQ(MessageOf([] { static_cast<void>(ConfigWith({.interface = "<eth1>"})); }),
            "interface: must be the name or an address of a network interface that is up, "
            "one of lo (127.0.0.1), eth0 (10.0.0.2) (got \"<eth1>\")");
  EXPECT_EQ(MessageOf([] { static_cast<void>(dds::DomainConfig({}, {})); }),
            "interface: must be the name or an address of a network interface that is up, "
            "of which there is none (got loopback)");
}

TEST(TopicName, IsWhatRos2Accepts) {
  for (const char* name : {"/brake", "/a/b_2/C", "/_a"})
    EXPECT_TRUE(dds::IsTopicName(name)) << name;
  for (const char* name : {"", "/", "brake", "/a/", "//a", "/a b", "/2a", "/a/2", "/a-b", "/ä"}) {
    EXPECT_FALSE(dds::IsTopicName(name)) << name;
  }
}

}  // namespace
}  // namespace railcast
