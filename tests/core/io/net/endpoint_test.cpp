#include "railcast/io/endpoint.h"

#include <gtest/gtest.h>
#include <net/if.h>
#include <netdb.h>
#include <sys/socket.h>

#include <array>
#include <string>

#include "tests/core/io/message_of.h"

namespace railcast {
namespace {

TEST(Endpoint, IsReadFromHostAndPort) {
  EXPECT_EQ(ParseEndpoint("192.168.1.201:2368", 1), (Endpoint{0xC0A801C9, 2368}));
  EXPECT_EQ(ParseEndpoint("127.0.0.1", 27400), (Endpoint{0x7F000001, 27400}));
  EXPECT_EQ(ParseEndpoint("localhost:99", 1), (Endpoint{0x7F000001, 99}));
}

TEST(Endpoint, IsReadFromAnAddressOfIpv6) {
  const Endpoint one = ParseEndpoint("[2001:db8::1]:2368", 1);
  const std::array<std::uint8_t, 16> expected = {0x20, 1, 0x0D, 0xB8, 0, 0, 0, 0,
                                                 0,    0, 0,    0,    0, 0, 0, 1};
  EXPECT_EQ(one.address.bytes, expected);
  EXPECT_EQ(one.address.interface, 0U);
  EXPECT_EQ(one.port, 2368);
  EXPECT_EQ(ParseEndpoint("[2001:DB8:0::1]", 2368), one);
  EXPECT_EQ(ParseEndpoint("2001:db8::1", 2368), one);
  // Without brackets no port can be told from the address.
  EXPECT_EQ(ParseEndpoint("::1:2368", 5), ParseEndpoint("[::1:2368]:5", 1));
  // RFC 4291, 2.5.5.2: another way to write an address of IPv4.
  EXPECT_EQ(ParseEndpoint("[::ffff:10.0.0.1]:5", 1), (Endpoint{0x0A000001, 5}));
}

// A group of the link, by /etc/hosts of Debian and others.
TEST(Endpoint, OfANameHasItsAddressOfIpv6WhereItHasNoOther) {
  const std::string name = "ip6-allnodes";
  addrinfo hints{};
  hints.ai_family = AF_INET6;
  addrinfo* found = nullptr;
  if (::getaddrinfo(name.c_str(), nullptr, &hints, &found) != 0) {
    GTEST_SKIP() << name << " is no name of this machine";
  }
  ::freeaddrinfo(found);
  EXPECT_EQ(ParseEndpoint(name + "%lo:2368", 1), ParseEndpoint("[ff02::1%lo]:2368", 1));
  EXPECT_EQ(MessageOf([&] { return ParseEndpoint(name, 1); }),
            "must name the network interface, as [fe80::1%eth0]:2368 does (got ip6-allnodes)");
}

TEST(Endpoint, HasTheInterfaceOfGroupsAndOfAddressesOfTheLink) {
  const unsigned loopback = ::if_nametoindex("lo");
  ASSERT_NE(loopback, 0U);
  EXPECT_EQ(ParseEndpoint("[fe80::1%lo]:5", 1).address.interface, loopback);
  EXPECT_EQ(ParseEndpoint("fe80::1%lo", 1), ParseEndpoint("[fe80::1%lo]:1", 5));
  EXPECT_EQ(ParseEndpoint("[ff05::1%lo]:5", 1).address.interface, loopback);
  EXPECT_EQ(ParseEndpoint("239.1.1.1%lo:5", 1).address.interface, loopback);
  EXPECT_EQ(ParseEndpoint("[ff05::1]:5", 1).address.interface, 0U);
  EXPECT_EQ(ParseEndpoint("239.1.1.1", 1).address.interface, 0U);
}

TEST(Endpoint, IsThisMachineWhereNoHostIsWritten) {
  EXPECT_EQ(ParseEndpoint(":2369", 1), (Endpoint{0x7F000001, 2369}));
}

TEST(Endpoint, IsReadBackFromItsText) {
  for (const char* text : {"127.0.0.1:2368", "255.255.255.255:1", "10.0.200.3:65535", "[::1]:2368",
                           "[::]:1", "[2001:db8::a:0:0:7]:65535", "[ff05::123]:9", "[ff02::1%lo]:9",
                           "[fe80::1%lo]:2368", "239.1.1.1:5", "239.1.1.1%lo:5"}) {
    EXPECT_EQ(EndpointText(ParseEndpoint(text, 7)), text);
  }
}

TEST(Endpoint, KnowsLoopbackAndBroadcast) {
  EXPECT_TRUE(ParseEndpoint("127.9.8.7", 1).is_loopback());
  EXPECT_FALSE(ParseEndpoint("128.0.0.1", 1).is_loopback());
  EXPECT_TRUE(ParseEndpoint("::1", 1).is_loopback());
  EXPECT_FALSE(ParseEndpoint("::", 1).is_loopback());
  EXPECT_FALSE(ParseEndpoint("::101", 1).is_loopback());
  EXPECT_TRUE(ParseEndpoint("255.255.255.255", 1).is_broadcast());
  EXPECT_FALSE(ParseEndpoint("192.168.1.255", 1).is_broadcast());
  EXPECT_FALSE(ParseEndpoint("ff02::1%lo", 1).is_broadcast());
}

TEST(Endpoint, KnowsGroups) {
  for (const char* text : {"224.0.0.1", "239.255.255.255", "ff02::1%lo", "ff0e::7"}) {
    EXPECT_TRUE(ParseEndpoint(text, 1).address.is_multicast()) << text;
  }
  for (const char* text :
       {"223.255.255.255", "240.0.0.0", "255.255.255.255", "::1", "fe80::1%lo"}) {
    EXPECT_FALSE(ParseEndpoint(text, 1).address.is_multicast()) << text;
  }
}

TEST(Endpoint, CoversItselfOrEveryPortOfItsAddress) {
  const Endpoint one{0x7F000001, 5};
  EXPECT_TRUE(one.Covers(one));
  EXPECT_FALSE(one.Covers({0x7F000001, 6}));
  const Endpoint any{0x7F000001, 0};
  EXPECT_TRUE(any.Covers(one));
  EXPECT_FALSE(any.Covers({0x7F000002, 5}));
}

TEST(Endpoint, SaysWhatIsWrongWithAText) {
  EXPECT_EQ(MessageOf([] { return ParseEndpoint("", 1); }),
            "must be HOST:PORT, HOST or :PORT (got nothing)");
  for (const std::string port : {"0", "65536", "-1", "12x", ""}) {
    EXPECT_EQ(MessageOf([&] { return ParseEndpoint("127.0.0.1:" + port, 1); }),
              "the port must be a whole number from 1 to 65535 (got 127.0.0.1:" + port + ")");
  }
  EXPECT_EQ(MessageOf([] { return ParseEndpoint("no.such.host.invalid:5", 1); }),
            "must be HOST:PORT with an IPv4 address, an IPv6 address in brackets, or a known name "
            "(got no.such.host.invalid:5)");
}

TEST(Endpoint, SaysWhatIsWrongWithAnAddressOfIpv6) {
  for (const std::string text :
       {"[::1", "[", "[]", "[]:5", "[::1]5", "[::1]]:5", "[::g]:5", "[1::2::3]:5", "a:b:c",
        "[127.0.0.1]:5", "[localhost]:5", "[::1 ]:5", "[%lo]:5"}) {
    EXPECT_EQ(MessageOf([&] { return ParseEndpoint(text, 1); }),
              "must be an IPv6 address, as [::1]:2368 or [fe80::1%eth0]:2368 (got " + text + ")");
  }
  for (const std::string text : {"[::1]:0", "[::1]:65536", "[::1]:", "[::1]:x"}) {
    EXPECT_EQ(MessageOf([&] { return ParseEndpoint(text, 1); }),
              "the port must be a whole number from 1 to 65535 (got " + text + ")");
  }
}

TEST(Endpoint, SaysWhatIsWrongWithAnInterface) {
  for (const std::string text : {"[fe80::1]:5", "febf::1", "[ff02::1]:5", "ff01::1"}) {
    EXPECT_EQ(MessageOf([&] { return ParseEndpoint(text, 1); }),
              "must name the network interface, as [fe80::1%eth0]:2368 does (got " + text + ")");
  }
  for (const std::string text : {"[fe80::1%no_such_one]:5", "ff02::1%", "239.1.1.1%:5"}) {
    EXPECT_EQ(MessageOf([&] { return ParseEndpoint(text, 1); }),
              "must name a network interface of this machine behind % (got " + text + ")");
  }
  for (const std::string text : {"[::1%lo]:5", "2001:db8::1%lo", "10.0.0.1%lo:5", "localhost%lo"}) {
    EXPECT_EQ(MessageOf([&] { return ParseEndpoint(text, 1); }),
              "must name no network interface, which multicast groups and link-local addresses "
              "alone have (got " +
                  text + ")");
  }
}

TEST(Endpoint, TakesNumericAddressesInDottedDecimalAlone) {
  EXPECT_EQ(ParseEndpoint("10.0.0.1", 1), (Endpoint{0x0A000001, 1}));
  EXPECT_EQ(ParseEndpoint("0.0.0.0", 1), (Endpoint{0, 1}));
  // inet_aton would read the first as 8.0.0.1, and accept others as addresses, too.
  for (const std::string host :
       {"010.0.0.1", "127.0.0.01", "127.1", "2130706433", "0x7f.0.0.1", "127.0.0.0x1", "0X7F000001",
        "300.1.2.3", "1.2.3.4.5", "127.0.0.1.", "1.2.3.08"}) {
    EXPECT_EQ(MessageOf([&] { return ParseEndpoint(host + ":5", 1); }),
              "a numeric address must be four numbers from 0 to 255 with dots between, none with a "
              "leading 0 (got " +
                  host + ":5)");
  }
}

}  // namespace
}  // namespace railcast
