#include "core/io/net/endpoint.h"

#include <gtest/gtest.h>

#include "tests/core/io/message_of.h"

namespace railcast {
namespace {

TEST(Endpoint, IsReadFromHostAndPort) {
  EXPECT_EQ(ParseEndpoint("192.168.1.201:2368", 1), (Endpoint{0xC0A801C9, 2368}));
  EXPECT_EQ(ParseEndpoint("127.0.0.1", 27400), (Endpoint{0x7F000001, 27400}));
  EXPECT_EQ(ParseEndpoint("localhost:99", 1), (Endpoint{0x7F000001, 99}));
}

TEST(Endpoint, IsThisMachineWhereNoHostIsWritten) {
  EXPECT_EQ(ParseEndpoint(":2369", 1), (Endpoint{0x7F000001, 2369}));
}

TEST(Endpoint, IsReadBackFromItsText) {
  for (const char* text : {"127.0.0.1:2368", "255.255.255.255:1", "10.0.200.3:65535"}) {
    EXPECT_EQ(EndpointText(ParseEndpoint(text, 7)), text);
  }
}

TEST(Endpoint, KnowsLoopbackAndBroadcast) {
  EXPECT_TRUE(ParseEndpoint("127.9.8.7", 1).is_loopback());
  EXPECT_FALSE(ParseEndpoint("128.0.0.1", 1).is_loopback());
  EXPECT_TRUE(ParseEndpoint("255.255.255.255", 1).is_broadcast());
  EXPECT_FALSE(ParseEndpoint("192.168.1.255", 1).is_broadcast());
}

TEST(Endpoint, SaysWhatIsWrongWithAText) {
  EXPECT_EQ(MessageOf([] { return ParseEndpoint("", 1); }),
            "must be HOST:PORT, HOST or :PORT (got nothing)");
  for (const std::string port : {"0", "65536", "-1", "12x", ""}) {
    EXPECT_EQ(MessageOf([&] { return ParseEndpoint("127.0.0.1:" + port, 1); }),
              "the port must be a whole number from 1 to 65535 (got 127.0.0.1:" + port + ")");
  }
  EXPECT_EQ(MessageOf([] { return ParseEndpoint("300.1.2.3:5", 1); }),
            "must be HOST:PORT with an IPv4 address or a known name (got 300.1.2.3:5)");
}

}  // namespace
}  // namespace railcast
